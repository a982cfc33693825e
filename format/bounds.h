// What a header tells of the surface before anything is decoded: the errors of levels and the boxes of images. Both count
// in fractions of the extent, 2^bits units.  spec/gim-format.md, "Header".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/bits.h"
#include "format/container.h"

namespace gim {

// An axis-aligned box, with coordinates as decoded positions have them.
struct Box {
    std::array<float, 3> low{}, high{};
};

// The error, in object units, that a code of a level stands for. 0: the file does not tell it.
inline float error_of(uint8_t error_code, const Units& units) {
    constexpr std::array<float, 10> kTenthsOfAnOctave = {1.0f,       1.0717734f, 1.1486983f, 1.2311444f, 1.3195079f,
                                                         1.4142135f, 1.5157166f, 1.6245048f, 1.7411011f, 1.8660660f};
    if (error_code == 0) return 0;
    const uint32_t tenths = error_code + 3u;
    const float extent = units.step * static_cast<float>(1u << units.bits);
    return extent * kTenthsOfAnOctave[tenths % 10] * (static_cast<float>(1u << (tenths / 10)) * 0x1p-25f);
}

// Returns the code of the smallest error that is at least `error`; 255 if the error is larger than all of them.
inline uint8_t error_code_of(double error, const Units& units) {
    uint8_t error_code = 1;
    while (error_code < 255 && !(double{error_of(error_code, units)} >= error)) ++error_code;
    return error_code;
}

inline constexpr int kBoxNumberBits = 9;
inline constexpr uint32_t kBoxNumberOfOrigin = 128, kMaxBoxNumber = 511;  // 256 numbers are one extent

// The coordinate along an axis that a number of a box stands for.
inline float box_coordinate(uint32_t number, size_t axis, const Units& units) {
    const float steps = static_cast<float>(static_cast<int32_t>(number - kBoxNumberOfOrigin)) *
                        static_cast<float>(1u << (units.bits - 8));
    return units.origin[axis] + units.step * steps;
}

// The six numbers of an image's box as stored: lower corner, upper corner. All are 0 if the file does not tell the box.
struct BoxNumbers {
    std::array<uint32_t, 6> of{};

    bool is_told() const { return of != std::array<uint32_t, 6>{}; }
    Box box(const Units& units) const {
        Box b;
        for (size_t k = 0; k < 3; ++k) {
            b.low[k] = box_coordinate(of[k], k, units);
            b.high[k] = box_coordinate(of[k + 3], k, units);
        }
        return b;
    }
};

// Returns false if they are malformed. Every call of the decoder checks the boxes of all images, so this takes them as
// one number.
inline bool read_box(std::span<const uint8_t, kBoxSize> bytes, BoxNumbers* numbers) {
    constexpr int kPadding = 8 * kBoxSize - 6 * kBoxNumberBits;
    uint64_t all = 0;
    for (const uint8_t byte : bytes) all = all << 8 | byte;
    for (size_t k = 0; k < 6; ++k) {
        const int below = kPadding + kBoxNumberBits * static_cast<int>(5 - k);
        numbers->of[k] = static_cast<uint32_t>(all >> below) & kMaxBoxNumber;
    }
    const auto& of = numbers->of;
    return (all & ((1u << kPadding) - 1)) == 0 && of[0] <= of[3] && of[1] <= of[4] && of[2] <= of[5];
}

inline void append_box(const BoxNumbers& numbers, std::vector<uint8_t>* bytes) {
    BitWriter bits(bytes);
    for (const uint32_t number : numbers.of) bits.write(number, kBoxNumberBits);
}

// Returns the smallest box that holds `box`; one that is not told if there is none.
inline BoxNumbers box_around(const Box& box, const Units& units) {
    BoxNumbers numbers;
    for (size_t k = 0; k < 3; ++k) {
        uint32_t low = kMaxBoxNumber, high = 0;
        while (low > 0 && !(box_coordinate(low, k, units) <= box.low[k])) --low;
        while (high < kMaxBoxNumber && !(box_coordinate(high, k, units) >= box.high[k])) ++high;
        if (!(box_coordinate(low, k, units) <= box.low[k] && box_coordinate(high, k, units) >= box.high[k])) return {};
        numbers.of[k] = low;
        numbers.of[k + 3] = high;
    }
    return numbers;
}

}  // namespace gim
