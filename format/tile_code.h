// Codes the details of tiles, tile by tile, with the models and contexts of squares (format/band_code.h).
// spec/gim-format.md, "Tiles". The details on an edge are coded with the tile of its lower half-edge. The other tile has
// them as known values, along its own axes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "format/band_code.h"
#include "format/quad_complex.h"
#include "format/tile_planes.h"

namespace gim {

// Tiles with fewer intervals in the small image have no flags of empty blocks.
inline constexpr uint32_t kLeastFlaggedTile = 4;

// Which of kTileWeights the step that begins with h intervals has.
constexpr uint32_t weights_step(uint32_t h) {
    return std::min(static_cast<uint32_t>(std::bit_width(h)), kTileSteps) - 1;
}

// The weights of that step, by orientation, for the first component and for later ones. Planes have those of squares.
constexpr const BandWeights (&tile_weights(CoefficientKind kind, uint32_t h))[3][2] {
    constexpr auto kPlanes = static_cast<size_t>(CoefficientKind::kPlanes);
    return kind == CoefficientKind::kPlanes ? kBandWeights[kPlanes][2 * h + 1 >= kFineSide]
                                            : kTileWeights[is_in_frames(kind)][weights_step(h)];
}

// Which bands of a tile had a block that is not empty: edges, faces.
using TileFlags = std::array<uint8_t, 2>;

template <class Coder>
class TileCoder : private BandCoder<Coder> {
  public:
    TileCoder(Coder* coder, BandModels* models, const BandWork& work) : BandCoder<Coder>(coder, models, work) {}

    // Codes one wavelet step of all tiles. details: complex.tiles times planes.details() numbers; a decoder's must be 0.
    // parents: those of the step before, or nullptr. flags: work space, one per tile.
    // Returns false if a value is larger than any that an encoder writes.
    bool code_step(const QuadComplex& complex, const TilePlanes& planes, int32_t* details, int32_t* parents,
                   TileFlags* flags);

  private:
    using BandCoder<Coder>::coder_;
    using BandCoder<Coder>::models_;
    using BandCoder<Coder>::work_;

    // The details in the row of an earlier tile beside this one, or none.
    struct Beyond {
        const int32_t* details = nullptr;
        const TileSide* side = nullptr;
        uint32_t h = 0;
        bool is_across = false;  // whether its second component is this tile's third

        // Writes the magnitudes of the face, or the edge that goes on straight, beside place t of this tile's side.
        void load(bool is_face, uint32_t t, uint32_t* magnitudes) const;
    };
    // What is known of a tile before it is coded.
    struct Known {
        bool side[4];                // the details on a side
        uint32_t left[2], above[2];  // as flags of blocks outside, of edges and of faces
        Beyond beyond_left, beyond_above;
    };

    Known known_of(const QuadComplex& complex, const TilePlanes& planes, uint32_t tile, const int32_t* details,
                   const TileFlags* flags) const;
    Beyond beyond(const QuadComplex& complex, const TilePlanes& planes, uint32_t half_edge,
                  const int32_t* details) const;
    bool code_band(const Band& band, const BandSurroundings& around, uint32_t h, const Known& known, uint8_t* full);
    uint32_t code_flags(const Band& band, const BandSurroundings& around, uint32_t row, uint32_t blocks,
                        const Known& known);
    bool has_values(const Band& band, Orientation orientation, const Known& known, uint32_t row, uint32_t rows_end,
                    uint32_t column, uint32_t columns_end) const;
    void load_magnitudes(const int32_t* values, uint32_t column) const {
        for (uint32_t k = 0; k < 3; ++k) work_.magnitudes[3 * column + k] = magnitude_of(values[3 * column + k]);
    }
    static void share_sides(const QuadComplex& complex, const TilePlanes& planes, uint32_t tile, bool turned,
                            int32_t* details);
};

// ---- implementation ----

// Turns a detail from the axes of a tile at one side of an edge to those of the tile at the other side.
template <class Number>
void turn_detail(uint32_t side, uint32_t mate_side, const Number* from, Number* to) {
    const uint32_t quarters = (mate_side + 2 - side) & 3;  // how far the mate's axes are turned
    const Number a = from[1], b = from[2];
    to[0] = from[0];
    to[1] = quarters == 0 ? a : quarters == 1 ? -b : quarters == 2 ? -a : b;
    to[2] = quarters == 0 ? b : quarters == 1 ? a : quarters == 2 ? -b : -a;
}

template <class Coder>
void TileCoder<Coder>::share_sides(const QuadComplex& complex, const TilePlanes& planes, uint32_t tile, bool turned,
                                   int32_t* details) {
    for (uint32_t s = 0; s < 4; ++s) {
        const uint32_t half_edge = 4 * tile + s, mate = complex.mate[half_edge];
        if (mate == kNoMate || mate < half_edge) continue;
        const int32_t* own = details + tile * planes.details() - planes.horizontal();
        int32_t* other = details + tile_of(mate) * planes.details() - planes.horizontal();
        for (uint32_t i = 0; i < planes.h; ++i) {
            const int32_t* from = own + planes.sides[s].high.at(i);
            int32_t* to = other + planes.sides[side_of(mate)].high.at(planes.h - 1 - i);
            if (turned)
                turn_detail(s, side_of(mate), from, to);
            else
                std::copy_n(from, 3, to);
        }
    }
}

template <class Coder>
void TileCoder<Coder>::Beyond::load(bool is_face, uint32_t t, uint32_t* magnitudes) const {
    const int32_t* v = details + (is_face ? side->faces.at(h - 1 - t) : side->across.at(h - t));
    magnitudes[0] = magnitude_of(v[0]);
    magnitudes[1] = magnitude_of(v[is_across ? 2 : 1]);
    magnitudes[2] = magnitude_of(v[is_across ? 1 : 2]);
}

template <class Coder>
typename TileCoder<Coder>::Beyond TileCoder<Coder>::beyond(const QuadComplex& complex, const TilePlanes& planes,
                                                           uint32_t half_edge, const int32_t* details) const {
    const uint32_t mate = complex.mate[half_edge];
    if (mate >= half_edge) return {};
    return {details + tile_of(mate) * planes.details() - planes.horizontal(), &planes.sides[side_of(mate)], planes.h,
            is_in_frames(models_.kind) && (side_of(mate) + side_of(half_edge)) % 2 != 0};
}

template <class Coder>
typename TileCoder<Coder>::Known TileCoder<Coder>::known_of(const QuadComplex& complex, const TilePlanes& planes,
                                                            uint32_t tile, const int32_t* details,
                                                            const TileFlags* flags) const {
    Known known{};
    const TileFlags* beside[4];
    for (uint32_t s = 0; s < 4; ++s) {
        const uint32_t mate = complex.mate[4 * tile + s];
        known.side[s] = mate < 4 * tile + s;
        beside[s] = mate < 4 * tile ? flags + tile_of(mate) : nullptr;
    }
    known.beyond_above = beyond(complex, planes, 4 * tile, details);
    known.beyond_left = beyond(complex, planes, 4 * tile + 3, details);
    const TileFlags* left = beside[3] ? beside[3] : beside[1] ? beside[1] : beside[2] ? beside[2] : beside[0];
    for (uint32_t f = 0; f < 2; ++f) {
        known.above[f] = beside[0] ? (*beside[0])[f] : 1;
        known.left[f] = left ? (*left)[f] : 1;
    }
    return known;
}

template <class Coder>
bool TileCoder<Coder>::code_step(const QuadComplex& complex, const TilePlanes& planes, int32_t* details,
                                 int32_t* parents, TileFlags* flags) {
    const TilePlanes parent_planes(planes.h / 2);
    const bool turned = is_in_frames(models_.kind);
    const auto& weights = tile_weights(models_.kind, planes.h);
    for (uint32_t t = 0; t < complex.tiles; ++t) {
        const LevelBands bands = planes.bands(details + t * planes.details());
        LevelBands of_parents;
        if (parents) of_parents = parent_planes.bands(parents + t * parent_planes.details());
        const auto around = [&](Orientation o, const Band* horizontal, const Band* vertical) {
            return BandSurroundings{o,        parents ? &of_parents.of(o) : nullptr, horizontal,
                                    vertical, weights[static_cast<size_t>(o)],       {}};
        };
        const Known known = known_of(complex, planes, t, details, flags);
        flags[t] = {0, 0};
        if (!code_band(bands.horizontal, around(Orientation::kHorizontal, nullptr, nullptr), planes.h, known,
                       &flags[t][0]) ||
            !code_band(bands.vertical, around(Orientation::kVertical, &bands.horizontal, nullptr), planes.h, known,
                       &flags[t][0]) ||
            !code_band(bands.diagonal, around(Orientation::kDiagonal, &bands.horizontal, &bands.vertical), planes.h,
                       known, &flags[t][1]))
            return false;
        share_sides(complex, planes, t, turned, details);
    }
    return true;
}

template <class Coder>
bool TileCoder<Coder>::has_values(const Band& band, Orientation orientation, const Known& known, uint32_t row,
                                  uint32_t rows_end, uint32_t column, uint32_t columns_end) const {
    if (orientation == Orientation::kHorizontal) {
        if (row == 0 && known.side[0]) ++row;
        if (rows_end == band.rows && known.side[2]) --rows_end;
    }
    if (orientation == Orientation::kVertical) {
        if (column == 0 && known.side[3]) ++column;
        if (columns_end == band.columns && known.side[1]) --columns_end;
    }
    for (uint32_t r = row; r < rows_end; ++r) {
        const int32_t* values = band.row(r);
        if (std::any_of(values + 3 * column, values + 3 * columns_end, [](int32_t v) { return v != 0; })) return true;
    }
    return false;
}

// Codes the flags of a row of blocks. The last block of a row or a column reaches up to the end of the band.
template <class Coder>
uint32_t TileCoder<Coder>::code_flags(const Band& band, const BandSurroundings& around, uint32_t row, uint32_t blocks,
                                      const Known& known) {
    const bool is_face = around.orientation == Orientation::kDiagonal;
    const bool is_last_row = row / 8 + 1 == blocks;
    uint32_t left = known.left[is_face], any = 0;
    for (uint32_t b = 0; b < blocks; ++b) {
        const bool is_last = b + 1 == blocks;
        uint32_t parents = 0;  // triples that are not zero; more than three count as three
        if (around.parent) {
            const uint32_t end = is_last ? around.parent->columns : b * 4 + 4;
            const uint32_t rows_end = is_last_row ? around.parent->rows : row / 2 + 4;
            for (uint32_t r = row / 2; r < rows_end && parents <= 2; ++r) {
                const int32_t* from = around.parent->row(r);
                for (uint32_t c = b * 4; c < end; ++c)
                    parents += (from[c * 3] | from[c * 3 + 1] | from[c * 3 + 2]) != 0;
            }
        }
        uint32_t flag = 0;
        if constexpr (Coder::kWrites)
            flag = has_values(band, around.orientation, known, row, is_last_row ? band.rows : row + 8, b * 8,
                              is_last ? band.columns : b * 8 + 8);
        BitModel& model = models_.block[left + 2 * work_.full_above[b] + 4 * ((parents > 0) + (parents > 2))];
        left = coder_.code_bit(model, flag);
        work_.full_above[b] = left;
        any |= left;
    }
    return any;
}

template <class Coder>
bool TileCoder<Coder>::code_band(const Band& band, const BandSurroundings& around, uint32_t h, const Known& known,
                                 uint8_t* full) {
    const uint32_t blocks = block_count(h);
    const bool is_face = around.orientation == Orientation::kDiagonal;
    const bool is_horizontal = around.orientation == Orientation::kHorizontal;
    const bool is_vertical = around.orientation == Orientation::kVertical;
    // Columns that are coded. The others are known.
    const uint32_t first = is_vertical && known.side[3] ? 1 : 0;
    const uint32_t last = is_vertical && known.side[1] ? band.columns - 1 : band.columns;
    std::fill_n(work_.magnitudes - 3, (size_t{band.columns} + 2) * 3, 0u);  // includes the margin at either end
    if (!is_horizontal && known.beyond_above.side) {
        for (uint32_t c = 0; c < band.columns; ++c)
            known.beyond_above.load(is_face, c, work_.magnitudes + size_t{c} * 3);
    }
    std::fill_n(work_.full_above, blocks, h < kLeastFlaggedTile ? 1u : known.above[is_face]);
    for (uint32_t row = 0; row < band.rows; ++row) {
        const bool begins_blocks = row % 8 == 0 && row / 8 < blocks;
        if (begins_blocks && h >= kLeastFlaggedTile)
            *full |= static_cast<uint8_t>(code_flags(band, around, row, blocks, known));
        const int32_t* values = band.row(row);
        const bool row_is_known =
            is_horizontal && ((row == 0 && known.side[0]) || (row + 1 == band.rows && known.side[2]));
        for (uint32_t b = 0; b < blocks;) {
            const uint32_t run = b++;
            if (!work_.full_above[run]) continue;
            while (b < blocks && work_.full_above[b]) ++b;
            const uint32_t begin = std::max(run * 8, first), end = b == blocks ? last : b * 8;
            if (row_is_known) {
                expect(around, row, begin, end, work_);  // weighs the parents, for the next row, too
                continue;
            }
            uint32_t before[3] = {0, 0, 0};
            if (begin == 1) {
                for (uint32_t k = 0; k < 3; ++k) before[k] = magnitude_of(values[k]);
            } else if (begin == 0 && !is_vertical && known.beyond_left.side) {
                known.beyond_left.load(is_face, band.rows - 1 - row, before);  // the side runs upwards
            }
            if (begin < end && !this->code_run(band, around, row, begin, end, before)) return false;
        }
        if (begins_blocks) {  // magnitudes in empty blocks are those of the row above, which belongs to other blocks
            for (uint32_t b = 0; b < blocks; ++b) {
                const uint32_t end = b + 1 == blocks ? band.columns : b * 8 + 8;
                if (!work_.full_above[b]) std::fill(work_.magnitudes + b * 24, work_.magnitudes + size_t{end} * 3, 0u);
            }
        }
        if (row_is_known)
            for (uint32_t c = 0; c < band.columns; ++c) load_magnitudes(values, c);
        if (first > 0) load_magnitudes(values, 0);
        if (last < band.columns) load_magnitudes(values, last);
    }
    return true;
}

}  // namespace gim
