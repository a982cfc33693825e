// Samples on a grid seen as a triangle surface: cells split as the decoder splits them, samples that are one surface
// point told by class, some samples perhaps undefined. What the two layouts, the square and the packed charts, have in
// common.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/charts/multi_chart_image.h"
#include "encoder/image/geometry_image.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Which samples are one surface point, and what surface they make. Does not depend on positions.
struct GridGluing {
    // Neighbours in the grid that an edge of the surface joins: bits of `edges`.
    enum Edge : uint8_t { kNorth = 1, kSouth = 2, kWest = 4, kEast = 8 };

    uint32_t width = 0, height = 0;
    std::vector<uint32_t> representative;  // per sample: the first of its class, itself if alone, kNone if undefined
    std::vector<std::vector<uint32_t>> shared;  // classes of more than one sample, ascending
    std::vector<uint32_t> class_of;             // per sample: index into `shared`, or kNone if alone
    std::vector<CellKind> kind;                 // per cell, row-major
    std::vector<uint8_t> edges;                 // per sample
    std::vector<bool> on_input_boundary;        // per sample: a boundary of the input's surface passes through it

    size_t sample_count() const { return representative.size(); }
    bool is_defined(uint32_t sample) const { return representative[sample] != kNone; }
    uint64_t defined_count() const;
    // The samples a b / c d.
    std::array<uint32_t, 4> corners(uint32_t cell) const {
        const uint32_t a = cell / (width - 1) * width + cell % (width - 1);
        return {a, a + 1, a + width, a + width + 1};
    }
};

// Fails when the sideband does not describe the ring of an image of that side.
Result<GridGluing> glue_ring(const Sideband& sideband, uint32_t side);

// Fails when the record does not fit the mask.
Result<GridGluing> glue_charts(const SampleMask& mask, const SeamRecord& seams);

// The triangles of a cell; those that are not there, or have two corners at one surface point, are kNoFace. Wound so that
// (d position / d column) x (d position / d row) is the front.
inline constexpr Triangle kNoFace{kNone, kNone, kNone};
std::array<Triangle, 2> split_cell(const std::vector<Vec3>& positions, const GridGluing& gluing, uint32_t cell);

// All triangles, cell after cell in row-major order. A slot is a place for a triangle: two to a cell.
struct GridFaces {
    std::vector<Triangle> triangles;
    std::vector<uint32_t> slot;  // per triangle: 2 * cell, or 2 * cell + 1
};
GridFaces triangulate_grid(const std::vector<Vec3>& positions, const GridGluing& gluing);

}  // namespace gim
