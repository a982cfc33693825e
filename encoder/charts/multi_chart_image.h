// The model of the multi-chart layout: an image with undefined samples, and the record of its seams.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Sections 3 and 4.5.
//
// What the record leaves out follows from the mask: a chart's border is the loop of its triangles' border edges, triangles
// on the left (trace_borders). A loop is cut into paths;
// two paths that are one curve on the surface are mates and are zipped together: a string of steps says which sample
// goes with which. So a reader of mask and record can glue the samples again after lossy coding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/charts/chart_mask.h"
#include "encoder/surface/mesh.h"
#include "format/chart_border.h"
#include "gim/encoder.h"

namespace gim {

struct SeamPath {
    uint32_t mate = kNone;  // number of the path on the other side, or kNone: an input boundary
    uint32_t length = 0;    // samples from its begin node to its end node, the begin not counted
};

struct SeamRecord {
    struct Loop {
        uint32_t start = 0;       // sample of the first path's begin node
        uint32_t path_count = 0;  // at least 1
    };
    std::vector<Loop> loops;      // one per chart
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

// Samples of every path from its begin to its end node, both included. Fails when the record does not fit the mask.
Result<std::vector<std::vector<uint32_t>>> path_samples(const SampleMask& mask, const SeamRecord& seams);

// Which samples are one surface point: per sample the smallest index of its class, kNone where undefined. Fails when the
// record does not fit the mask (lengths, mates, steps). O(samples).
Result<std::vector<uint32_t>> glue_samples(const SampleMask& mask, const SeamRecord& seams);

// The triangles of one cell of a mask.
enum class CellKind : uint8_t {
    kEmpty,  // fewer than three defined samples
    kNoFirst,
    kNoSecond,
    kNoThird,
    kNoFourth,  // one triangle; the corners are counted (0, 0) (0, 1) (1, 1) (1, 0)
    kShorter,
    kMain,
    kAnti,  // two (format/split.h)
};
// (width - 1) * (height - 1) cells, row-major. `point`: of glue_samples.
std::vector<CellKind> classify_cells(const SampleMask& mask, const std::vector<uint32_t>& point);
// The triangles of a cell with first sample `first`: 0 to 2, counter-clockwise with columns along x and rows along y, also
// those with two corners in one point. main: whether kShorter is to be split along the main diagonal.
struct CellTriangles {
    std::array<Triangle, 2> triangles;
    uint32_t count = 0;
};
CellTriangles triangles_of_cell(CellKind kind, uint32_t first, uint32_t width, bool main);

// A triangle over samples, and its cell.
struct CellTriangle {
    Triangle corners{};
    uint32_t cell = 0;
};
// All triangles of all cells, split as the decoder splits them, also those with two corners in one point. point: of
// glue_samples.
std::vector<CellTriangle> triangles_of(const MultiChartImage& image, const std::vector<uint32_t>& point);

// How the surface is put together: vertices are classes of samples, triangles those of the cells that have three
// different vertices, split as the decoder splits them (format/chart_split.h).
struct Reconstruction {
    Mesh mesh;
    std::vector<uint32_t> sample;  // per vertex: the first sample of its class
};
Result<Reconstruction> reconstruct(const MultiChartImage& image);

}  // namespace gim
