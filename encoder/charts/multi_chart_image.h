// An image of packed charts, with undefined samples, and the record of its seams.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Sections 3 and 4.5.
//
// The mask says what the record leaves out: a chart's border is the loop of its triangles' border edges, with the
// triangles on the left (trace_borders). A loop is cut into paths. Two paths that are one curve on the surface are
// mates and are zipped together: a string of steps says which sample goes with which. So a reader of mask and record
// can glue the samples again after lossy coding.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/chart_mask.h"
#include "encoder/image/geometry_image.h"
#include "encoder/surface/mesh.h"
#include "format/chart_border.h"
#include "gim/encoder.h"

namespace gim {

struct SeamPath {
    uint32_t mate = kNoMate;  // number of the path on the other side, or kNoMate
    uint32_t length = 0;      // samples from its begin node to its end node, the begin not counted
};

struct SeamRecord {
    struct Loop {
        uint32_t start = 0;       // sample of the first path's begin node
        uint32_t path_count = 0;  // at least 1
    };
    std::vector<Loop> loops;      // one per chart
    std::vector<SeamPath> paths;  // loop after loop, along the loops
    // The steps of each path whose mate has a higher number, in order. kBoth and kFirst together occur `length` times.
    std::vector<std::vector<ZipStep>> zippers;
};

// A geometry image of packed charts, with the mask and seams that its gluing is made from (glue_charts.h).
struct MultiChartImage : GeometryImage {
    SampleMask mask;
    SeamRecord seams;
};

// Returns the samples of every path from its begin node to its end node, both included. Fails if the record does not
// fit the mask.
Result<std::vector<std::vector<uint32_t>>> path_samples(const SampleMask& mask, const SeamRecord& seams);

// Finds which samples are one surface point. Returns per sample the smallest index of its class, or kNone if it is
// undefined. Fails if the record does not fit the mask (lengths, mates, steps). O(samples).
Result<std::vector<uint32_t>> glue_samples(const SampleMask& mask, const SeamRecord& seams);

// Finds which triangles each cell of a mask has: (width - 1) * (height - 1) cells, row-major. point: from
// glue_samples(). Splits cells as the decoder does (format/chart_split.h).
std::vector<CellKind> classify_cells(const SampleMask& mask, const std::vector<uint32_t>& point);

}  // namespace gim
