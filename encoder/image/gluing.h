// A grid of samples as a triangle surface. The gluing says which samples are one surface point, which are undefined,
// and which triangles each cell has. Cells are split as the decoder splits them. All layouts share this model.
#pragma once

#include <algorithm>
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
    kNoFourth,  // one triangle; corners are numbered (0, 0) (0, 1) (1, 1) (1, 0)
    kShorter,
    kMain,
    kAnti,  // two triangles (format/split.h)
};
CellKind kind_of(Split split);

// Says which samples are one surface point, and which surface they make. Does not depend on positions.
struct GridGluing {
    // Bits of `edges`: grid neighbours to which an edge of the surface leads.
    enum Edge : uint8_t { kNorth = 1, kSouth = 2, kWest = 4, kEast = 8 };

    uint32_t width = 0, height = 0;
    std::vector<uint32_t> representative;  // per sample: the first of its class, itself if alone, kNone if undefined
    std::vector<std::vector<uint32_t>> shared;  // classes of more than one sample, ascending
    std::vector<uint32_t> class_of;             // per sample: index into `shared`, or kNone if alone
    std::vector<CellKind> kind;                 // per cell, row-major
    std::vector<uint8_t> edges;                 // per sample
    std::vector<bool> on_input_boundary;        // per sample: lies on a boundary of the input's surface

    size_t sample_count() const { return representative.size(); }
    bool is_defined(uint32_t sample) const { return representative[sample] != kNone; }
    uint64_t defined_count() const;
    // Returns the samples at the corners: a, b and below them c, d.
    std::array<uint32_t, 4> corners(uint32_t cell) const {
        const uint32_t a = cell / (width - 1) * width + cell % (width - 1);
        return {a, a + 1, a + width, a + width + 1};
    }
};

// What a layout knows about its samples.
struct GluedSamples {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> defined;                // per sample; empty: all are
    std::vector<std::vector<uint32_t>> classes;  // samples that are one surface point; single samples may be left out
    std::vector<bool> on_input_boundary;         // per sample
    std::vector<CellKind> kind;                  // per cell, row-major
};
// O(samples).
GridGluing make_gluing(GluedSamples samples);

// All triangles of a cell, including those with two corners at one surface point. Their front is the direction of
// (d position / d column) x (d position / d row).
struct CellTriangles {
    std::array<Triangle, 2> triangles;
    uint32_t count = 0;
};
CellTriangles cell_triangles(const std::vector<Vec3>& positions, const GridGluing& gluing, uint32_t cell);

// The same, but triangles that are missing or have two corners at one surface point are kNoFace.
inline constexpr Triangle kNoFace{kNone, kNone, kNone};
std::array<Triangle, 2> split_cell(const std::vector<Vec3>& positions, const GridGluing& gluing, uint32_t cell);

// The triangles of all cells, in row-major order, without kNoFace. A slot is a place for a triangle; a cell has two.
struct GridFaces {
    std::vector<Triangle> triangles;
    std::vector<uint32_t> slot;  // per triangle: 2 * cell, or 2 * cell + 1
};
GridFaces triangulate_grid(const std::vector<Vec3>& positions, const GridGluing& gluing);

// Calls body(cell) for the up to four cells at a sample, row by row.
template <class Body>
void for_each_cell_at(const GridGluing& gluing, uint32_t sample, const Body& body) {
    const uint32_t width = gluing.width, row = sample / width, column = sample % width;
    for (uint32_t r = row > 0 ? row - 1 : 0; r <= std::min(row, gluing.height - 2); ++r) {
        for (uint32_t c = column > 0 ? column - 1 : 0; c <= std::min(column, width - 2); ++c) body(r * (width - 1) + c);
    }
}

}  // namespace gim
