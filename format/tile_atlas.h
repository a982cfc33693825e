// Where tiles lie in a grid of samples: in slots of a rectangle, tile after tile, row by row. The samples on the border of
// a tile are repeated in every tile that has them.  spec/gim-format.md, "Tiles".
#pragma once

#include <cstdint>

namespace gim {

inline constexpr uint32_t kMostTileExponent = 10;
inline constexpr uint64_t kMostTileSamples = uint64_t{1} << 30;

class TileAtlas {
  public:
    // intervals: along a side of a tile.
    TileAtlas(uint32_t tiles, uint32_t intervals) : slot_(intervals + 1) {
        uint32_t least = 1;  // the smallest number of columns that makes no more rows than columns
        while (uint64_t{least} * least < tiles) ++least;
        columns_ = least;
        for (uint32_t c = least; c <= least + least / 4; ++c) {
            if (slots(tiles, c) < slots(tiles, columns_)) columns_ = c;
        }
        rows_ = (tiles + columns_ - 1) / columns_;
    }

    uint32_t width() const { return columns_ * slot_; }
    uint32_t height() const { return rows_ * slot_; }
    uint64_t samples() const { return uint64_t{width()} * height(); }
    // The first column and row of a tile.
    uint32_t column(uint32_t tile) const { return tile % columns_ * slot_; }
    uint32_t row(uint32_t tile) const { return tile / columns_ * slot_; }

  private:
    static uint32_t slots(uint32_t tiles, uint32_t columns) { return (tiles + columns - 1) / columns * columns; }

    uint32_t slot_, columns_ = 1, rows_ = 1;
};

}  // namespace gim
