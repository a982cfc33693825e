// What a quantized coefficient costs in bits, estimated from the image's own statistics.
//
// The coder's models adapt to the magnitudes around a coefficient (format/band_code.h). Here a coefficient's class is
// the mean magnitude of its neighbours in the band and of the other components. A class's price of a magnitude is minus
// the logarithm of how often the class has it. So a change is priced with what it does to the neighbours' classes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "format/band.h"

namespace gim {

// Returns the bands of all levels of images.
std::vector<Band> all_bands(std::span<const Pyramid<int32_t>> images);

class CoefficientPrices {
  public:
    // Counts the details of all bands. O(coefficients).
    explicit CoefficientPrices(std::span<const Band> bands);
    // The same for all bands of images.
    explicit CoefficientPrices(std::span<const Pyramid<int32_t>> images);

    // Returns by how many bits a band grows if the component of one detail changes by `by`.
    double bits_of_change(const Band& band, uint32_t row, uint32_t column, uint32_t component, int32_t by) const;

  private:
    static constexpr uint32_t kClasses = 8, kMagnitudes = 16;
    // By whether the component is tangential, by class, by magnitude; the last one stands for all larger ones.
    std::array<std::array<std::array<double, kMagnitudes>, kClasses>, 2> bits_{};

    template <class At>
    static uint32_t class_of(const Band& band, uint32_t row, uint32_t column, uint32_t component, const At& at);
};

}  // namespace gim
