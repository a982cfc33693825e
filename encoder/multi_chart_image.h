// The model of the multi-chart layout: an image with undefined samples, and the record of its seams.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Sections 3 and 4.5.
//
// What the record leaves out follows from the mask: charts are the border loops of the mask's triangles, in the order of
// their first samples in row-major order, each with its triangles on the left (trace_borders). A loop is cut into paths;
// two paths that are one curve on the surface are mates and are zipped together: a string of steps says which sample
// goes with which. So a reader of mask and record can glue the samples again after lossy coding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/chart_mask.h"
#include "encoder/mesh.h"
#include "gim/encoder.h"

namespace gim {

// One step of a zipper from sample to sample along two mated paths, the second walked backwards.
enum class ZipStep : uint8_t {
    kBoth = 0,    // on to the next sample on both sides, which become one surface point
    kFirst = 1,   // on along the first path: its next sample joins the current point
    kSecond = 2,  // on along the second
};

struct SeamPath {
    uint32_t mate = kNone;  // number of the path on the other side, or kNone: an input boundary
    uint32_t length = 0;    // samples from its begin node to its end node, the begin not counted
};

struct SeamRecord {
    struct Loop {
        uint32_t first = 0;       // index along the loop of the first path's begin node
        uint32_t path_count = 0;  // at least 1
    };
    std::vector<Loop> loops;      // as trace_borders lists them
    std::vector<SeamPath> paths;  // loop after loop, along the loops
    // Per path with a mate of a higher number, in order: its steps, with as many kBoth and kFirst as the path is long.
    std::vector<std::vector<ZipStep>> zippers;
};

struct MultiChartImage {
    SampleMask mask;
    std::vector<Vec3> positions;  // row-major; zero where undefined
    SeamRecord seams;

    uint32_t width() const { return mask.width; }
    uint32_t height() const { return mask.height; }
};

// Which samples are one surface point: per sample the smallest index of its class, kNone where undefined. Fails when the
// record does not fit the mask (lengths, mates, steps). O(samples).
Result<std::vector<uint32_t>> glue_samples(const SampleMask& mask, const SeamRecord& seams);

// How the surface is put together: vertices are classes of samples, triangles those of the solid quads that have three
// different vertices. A quad of four is split along the shorter diagonal, except that a diagonal between two border
// samples is avoided where the other is none, and that of two such the main one (column, row) - (column + 1, row + 1) is
// taken: so the connectivity depends on positions only where it cannot do harm.
struct Reconstruction {
    Mesh mesh;
    std::vector<uint32_t> sample;  // per vertex: the first sample of its class
};
Result<Reconstruction> reconstruct(const MultiChartImage& image);

}  // namespace gim
