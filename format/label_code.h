// Labels of cells: how they are coded, the same for encoder and decoder.  spec/gim-format.md, "Labels".
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/bit_model.h"
#include "format/container.h"

namespace gim {

// The decisions of one stream.
struct LabelModels {
    BitModel is_new[8];    // differs from the left one; by equality of the neighbours
    BitModel is_other[4];  // differs from the upper one too
    BitModel bits[256];    // the path to a value, from its highest bit on
};

template <class Coder>
uint8_t code_label_value(Coder& coder, LabelModels& models, uint8_t value) {
    uint32_t path = 1;
    for (int bit = 7; bit >= 0; --bit) path = 2 * path + coder.code_bit(models.bits[path], value >> bit & 1u);
    return static_cast<uint8_t>(path);
}

// Codes a row of `count` labels. row: the labels above, which become those of the row. values: what an encoder codes; a
// decoder gives nullptr.
template <class Coder>
void code_label_row(Coder& coder, LabelModels& models, uint32_t count, const uint8_t* values, uint8_t* row) {
    uint8_t left = row[0], corner = row[0];
    for (uint32_t c = 0; c < count; ++c) {
        const uint8_t above = row[c], right = row[c + 1 < count ? c + 1 : c];
        const uint8_t value = values ? values[c] : uint8_t{0};
        const uint32_t above_is = (above == corner ? 1u : 0u) + (above == right ? 2u : 0u);
        uint8_t label = left;
        if (coder.code_bit(models.is_new[2 * above_is + (left == above ? 1 : 0)], value != left ? 1 : 0) != 0) {
            const bool may_be_above = above != left;
            label = may_be_above && coder.code_bit(models.is_other[above_is], value != above ? 1 : 0) == 0
                        ? above
                        : code_label_value(coder, models, value);
        }
        corner = above;
        row[c] = left = label;
    }
}

// The squares of cells that the labels of one image lie on, at the finest level before the file was cut.
struct LabelSquares {
    uint32_t count, side;

    uint64_t cells() const { return uint64_t{count} * side * side; }
};

// Not of kCharts.
inline LabelSquares label_squares(const Header& header, uint32_t image) {
    if (header.layout == FileLayout::kTiles) return {header.tiles.tiles, header.tiles.intervals(0)};
    return {1, header.side(image) - 1};
}

// Codes the labels of squares, one after the other. row: `side` bytes of work space. values(square, r): the row of labels
// that an encoder codes, nullptr for a decoder. take(square, r): row is complete.
template <class Coder, class Values, class Take>
void code_labels(Coder& coder, const LabelSquares& squares, uint8_t* row, const Values& values, const Take& take) {
    LabelModels models;
    uint8_t first = 0;
    for (uint32_t square = 0; square < squares.count; ++square) {
        for (uint32_t c = 0; c < squares.side; ++c) row[c] = first;
        for (uint32_t r = 0; r < squares.side; ++r) {
            code_label_row(coder, models, squares.side, values(square, r), row);
            if (r == 0) first = row[0];
            take(square, r);
        }
    }
}

}  // namespace gim
