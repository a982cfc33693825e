// What all refined meshes of one decoded image share: tiles, how they are glued, and what each sample is worth.
// Maximo, Velho, Siqueira. Adaptive Multi-chart and Multiresolution Mesh Representation. 2013, section 4.3.
//
// The image of a square is many tiles: the cells of its coarsest level. So one structure serves both layouts. Samples are
// numbered as the vertices of gim_decode_mesh at the same level.
#pragma once

#include <cstddef>
#include <cstdint>

#include "decoder/layout/tile_glue.h"
#include "decoder/pyramid/arena.h"

namespace gim {

// What a sample is worth as a vertex, in object units.
struct SampleValue {
    float position[3];
    float error;   // how far the mesh is from it, and from all samples below it, while it is missing
    float radius;  // of a ball around the position that holds those samples
};

class QuadDomain {
  public:
    QuadDomain() = default;
    QuadDomain(const DomainShape& shape, const TileGlue& glue, const SampleValue* values)
        : shape_(shape), glue_(glue), values_(values) {}

    const DomainShape& shape() const { return shape_; }
    const TileGlue& glue() const { return glue_; }
    const SampleValue& value(uint32_t vertex) const { return values_[vertex]; }

    uint32_t vertex_at(uint32_t tile, uint32_t row, uint32_t column) const {
        const uint32_t n = shape_.intervals, first = 4 * tile;
        if (row > 0 && row < n && column > 0 && column < n)
            return glue_.inner[tile] + (row - 1) * glue_.row_step + column - 1;
        if (row == 0) return column == n ? glue_.corner[first + 1] : on_side(first, column);
        if (column == n) return row == n ? glue_.corner[first + 2] : on_side(first + 1, row);
        if (row == n) return column == 0 ? glue_.corner[first + 3] : on_side(first + 2, n - column);
        return on_side(first + 3, n - row);
    }

  private:
    // t: 0 .. intervals - 1.
    uint32_t on_side(uint32_t half_edge, uint32_t t) const {
        if (t == 0) return glue_.corner[half_edge];
        return glue_.along[half_edge] + (t - 1) * static_cast<uint32_t>(glue_.step[half_edge]);
    }

    DomainShape shape_;
    TileGlue glue_;
    const SampleValue* values_ = nullptr;
};

// Room for the arrays, in the arena.
TileGlue lay_out_glue(const DomainShape& shape, Arena* arena);

// Chooses the diagonal of each tile: the shorter one, except where another edge joins the same vertices. prefers: what
// decides before the length, per tile: 0 or 1 as is_anti, 2 for nothing. edges: room for edge_slots(shape) numbers.
// Cost: O(tiles).
uint32_t edge_slots(const DomainShape& shape);
void choose_diagonals(const DomainShape& shape, const float* positions, uint64_t* edges, TileGlue* glue);

// Sets the values of all samples from their positions (triples). Cost: O(samples).
void rate_samples(const QuadDomain& domain, const float* positions, SampleValue* values);

}  // namespace gim
