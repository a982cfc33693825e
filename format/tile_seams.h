// Codes the seams of a complex: how tiles are glued, and which edges are sharp.  spec/gim-format.md, "Tiles".
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "format/bit_model.h"
#include "format/container.h"
#include "format/quad_code.h"

namespace gim {

// Source: as code_quads asks for; and bool is_sharp(half_edge), of the code.
// Fills the complex, whose number of tiles is set; and work.fan, per edge 1 if it is sharp. Returns false if the bits say what no writer writes.
template <class Coder, class Source>
bool code_tile_seams(Coder& coder, Source& source, const TileShape& shape, const QuadCodeWork& work,
                     QuadComplex* complex) {
    QuadModels models;
    if (!code_quads(coder, models, source, work, complex) || !number_complex(complex)) return false;
    if (!shape.has_sharp_edges) return true;
    // Sharp edges follow each other. So what is known of the two vertices tells much: 0 nothing, 1 a smooth edge only,
    // 2 one sharp edge, 3 more.
    std::array<BitModel, 16> sharp;
    uint32_t* sharp_at = work.next;  // no longer needed
    uint32_t* is_sharp = work.fan;
    std::fill_n(sharp_at, complex->vertices, 0u);
    for (uint32_t e = 0; e < complex->edges; ++e) {
        const uint32_t h = complex->lower[e];
        uint32_t &a = sharp_at[complex->vertex[h]], &b = sharp_at[complex->vertex[next_side(h)]];
        uint32_t bit = 0;
        if constexpr (Coder::kWrites) bit = source.is_sharp(h);
        bit = coder.code_bit(sharp[4 * std::min(a, b) + std::max(a, b)], bit);
        is_sharp[e] = bit;
        for (uint32_t* v : {&a, &b}) *v = bit ? (*v < 2 ? 2 : 3) : std::max(*v, 1u);
    }
    return true;
}

}  // namespace gim
