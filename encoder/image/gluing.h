// A grid of samples as a triangle surface. The gluing says which samples are one surface point, which are undefined, and
// which triangles each cell carries. Cells are split as the decoder splits them. All layouts have this in common.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "format/split.h"

namespace gim {

// The triangles of one cell.
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
CellKind kind_of(Split split);

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

// What a layout knows of its samples.
struct GluedSamples {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> defined;                // per sample; empty: all are
    std::vector<std::vector<uint32_t>> classes;  // samples that are one surface point; those alone may be left out
    std::vector<bool> on_input_boundary;         // per sample
    std::vector<CellKind> kind;                  // per cell, row-major
};
// O(samples).
GridGluing make_gluing(GluedSamples samples);

// All triangles of a cell, also those with two corners at one surface point. Wound so that
// (d position / d column) x (d position / d row) is the front.
struct CellTriangles {
    std::array<Triangle, 2> triangles;
    uint32_t count = 0;
};
CellTriangles cell_triangles(const std::vector<Vec3>& positions, const GridGluing& gluing, uint32_t cell);

// The same; triangles that are not there, or have two corners at one surface point, are kNoFace.
inline constexpr Triangle kNoFace{kNone, kNone, kNone};
std::array<Triangle, 2> split_cell(const std::vector<Vec3>& positions, const GridGluing& gluing, uint32_t cell);

// All triangles, cell after cell in row-major order. A slot is a place for a triangle: two to a cell.
struct GridFaces {
    std::vector<Triangle> triangles;
    std::vector<uint32_t> slot;  // per triangle: 2 * cell, or 2 * cell + 1
};
GridFaces triangulate_grid(const std::vector<Vec3>& positions, const GridGluing& gluing);

}  // namespace gim
