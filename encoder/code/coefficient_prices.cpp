#include "encoder/code/coefficient_prices.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace gim {

namespace {

constexpr double kSignBit = 1;
constexpr double kSeen = 0.5;  // each magnitude counts as seen so often before it is

uint32_t magnitude_at(const Band& band, uint32_t row, uint32_t column, uint32_t k) {
    return static_cast<uint32_t>(std::abs(band.row(row)[3 * size_t{column} + k]));
}

}  // namespace

std::vector<Band> all_bands(std::span<const Pyramid<int32_t>> images) {
    std::vector<Band> bands;
    for (const Pyramid<int32_t>& image : images) {
        for (uint32_t level = 0; level < image.steps(); ++level) {
            const LevelBands of_level = bands_of(const_cast<Pyramid<int32_t>&>(image), level);
            bands.insert(bands.end(), {of_level.horizontal, of_level.vertical, of_level.diagonal});
        }
    }
    return bands;
}

// at(row, column, component) returns a magnitude.
template <class At>
uint32_t CoefficientPrices::class_of(const Band& band, uint32_t row, uint32_t column, uint32_t component,
                                     const At& at) {
    constexpr uint32_t most = 4;
    uint32_t sum = 0;  // direct neighbours count twice
    for (uint32_t other = 0; other < 3; ++other) {
        if (other != component) sum += 2 * std::min(at(row, column, other), most);
    }
    for (uint32_t r = row - std::min(row, 1u); r <= std::min(row + 1, band.rows - 1); ++r) {
        for (uint32_t c = column - std::min(column, 1u); c <= std::min(column + 1, band.columns - 1); ++c) {
            if (r == row && c == column) continue;
            const uint32_t weight = r == row || c == column ? 2 : 1;
            sum += weight * std::min(at(r, c, component), most);
        }
    }
    return std::min<uint32_t>(sum < 4 ? sum : 2 + static_cast<uint32_t>(std::bit_width(sum)) - 1, kClasses - 1);
}

CoefficientPrices::CoefficientPrices(std::span<const Band> bands) {
    for (auto& kind : bits_) {
        for (auto& magnitudes : kind) magnitudes.fill(kSeen);
    }
    for (const Band& band : bands) {
        const auto at = [&](uint32_t r, uint32_t c, uint32_t k) { return magnitude_at(band, r, c, k); };
        for (uint32_t row = 0; row < band.rows; ++row) {
            for (uint32_t column = 0; column < band.columns; ++column) {
                for (uint32_t k = 0; k < 3; ++k) {
                    const uint32_t magnitude = std::min(at(row, column, k), kMagnitudes - 1);
                    bits_[k > 0][class_of(band, row, column, k, at)][magnitude] += 1;
                }
            }
        }
    }
    for (auto& kind : bits_) {
        for (auto& magnitudes : kind) {
            double all = 0;
            for (const double count : magnitudes) all += count;
            for (uint32_t m = 0; m < kMagnitudes; ++m)
                magnitudes[m] = std::log2(all / magnitudes[m]) + (m > 0 ? kSignBit : 0);
        }
    }
}

CoefficientPrices::CoefficientPrices(std::span<const Pyramid<int32_t>> images) : CoefficientPrices(all_bands(images)) {}

double CoefficientPrices::bits_of_change(const Band& band, uint32_t row, uint32_t column, uint32_t component,
                                         int32_t by) const {
    const auto before = [&](uint32_t r, uint32_t c, uint32_t k) { return magnitude_at(band, r, c, k); };
    const int32_t changed = band.row(row)[3 * size_t{column} + component] + by;
    const auto after = [&](uint32_t r, uint32_t c, uint32_t k) {
        return r == row && c == column && k == component ? static_cast<uint32_t>(std::abs(changed))
                                                         : magnitude_at(band, r, c, k);
    };
    double bits = 0;
    const auto add = [&](uint32_t r, uint32_t c, uint32_t k) {
        const auto& prices = bits_[k > 0];
        bits += prices[class_of(band, r, c, k, after)][std::min(after(r, c, k), kMagnitudes - 1)] -
                prices[class_of(band, r, c, k, before)][std::min(before(r, c, k), kMagnitudes - 1)];
    };
    for (uint32_t k = 0; k < 3; ++k) {
        if (k != component) add(row, column, k);
    }
    for (uint32_t r = row - std::min(row, 1u); r <= std::min(row + 1, band.rows - 1); ++r) {
        for (uint32_t c = column - std::min(column, 1u); c <= std::min(column + 1, band.columns - 1); ++c)
            add(r, c, component);
    }
    return bits;
}

}  // namespace gim
