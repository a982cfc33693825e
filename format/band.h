// Bands of integer triples, and how a run of samples splits into them.  spec/gim-format.md, "Bands".
#pragma once

#include <cstddef>
#include <cstdint>

namespace gim {

enum class Orientation : uint8_t { kHorizontal, kVertical, kDiagonal };  // the direction of high frequency

// A grid of rows * columns triples, row-major, without gaps.
struct Band {
    int32_t* values = nullptr;
    uint32_t rows = 0, columns = 0;

    size_t count() const { return size_t{rows} * columns * 3; }
    int32_t* row(uint32_t r) const { return values + size_t{r} * columns * 3; }
};

// How many low and high samples a run of n samples splits into (format/lifting.h).
constexpr uint32_t low_count(uint32_t n) { return n - n / 2; }
constexpr uint32_t high_count(uint32_t n) { return n / 2; }

// How many of n samples are left after `steps` wavelet steps.
constexpr uint32_t halved(uint32_t n, uint32_t steps) {
    for (; steps > 0; --steps) n = low_count(n);
    return n;
}

// The three bands from which one wavelet step makes an image.
struct LevelBands {
    Band horizontal;  // low_count(rows) x high_count(columns)
    Band vertical;    // high_count(rows) x low_count(columns)
    Band diagonal;    // high_count(rows) x high_count(columns)

    const Band& of(Orientation orientation) const {
        return orientation == Orientation::kHorizontal ? horizontal
               : orientation == Orientation::kVertical ? vertical
                                                       : diagonal;
    }
};

}  // namespace gim
