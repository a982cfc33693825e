// Splits an image into wavelet bands. Mirror of the decoder's synthesis.h.  spec/gim-format.md, "Wavelets".
// In:  rows*columns interleaved triples, integers (reversible 5/3) or floats in units (9/7).
// Out: all bands down to the base. Cost: O(samples). Deterministic.
#pragma once

#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "format/band_code.h"
#include "format/lifting.h"
#include "format/rim.h"

namespace gim {

// The bands of one step, as triples.
template <class Sample>
struct AnalysisLevel {
    std::vector<Sample> horizontal, vertical, diagonal;
};

template <class Sample>
struct Pyramid {
    uint32_t columns = 0, rows = 0;             // of the image
    std::vector<Sample> base;                   // the coarsest image
    std::vector<AnalysisLevel<Sample>> levels;  // coarsest first

    uint32_t steps() const { return static_cast<uint32_t>(levels.size()); }
    // Size of the image that the base and the first `step` levels make.
    uint32_t columns_at(uint32_t step) const { return halved(columns, steps() - step); }
    uint32_t rows_at(uint32_t step) const { return halved(rows, steps() - step); }
};

// The bands of an image, all zero. O(samples).
Pyramid<float> zero_pyramid(uint32_t columns, uint32_t rows, uint32_t steps);

// columns, rows: at least 2 before each step. seams: of a square that is cut at its cut-nodes (format/rim.h), 9/7 only.
template <class Wavelet>
Pyramid<typename Wavelet::Sample> analyse(std::vector<typename Wavelet::Sample> image, uint32_t columns, uint32_t rows,
                                          uint32_t steps, const SeamTable* seams = nullptr);

// Splits a square of side 2^j + 1, down to 2 x 2.
template <class Wavelet>
Pyramid<typename Wavelet::Sample> analyse(std::vector<typename Wavelet::Sample> image, uint32_t side,
                                          const SeamTable* seams = nullptr) {
    return analyse<Wavelet>(std::move(image), side, side, static_cast<uint32_t>(std::countr_zero(side - 1)), seams);
}

// Makes the image again from the bands that analyse() returns. The decoder's synthesis.h is the inverse that counts.
template <class Wavelet>
std::vector<typename Wavelet::Sample> restore(const Pyramid<typename Wavelet::Sample>& pyramid,
                                              const SeamTable* seams = nullptr);

// The transpose of restore<Irreversible97>, seen as a linear map from bands to images. Sizes are as in analyse().
Pyramid<float> restore_transposed(std::vector<float> image, uint32_t columns, uint32_t rows, uint32_t steps,
                                  const SeamTable* seams = nullptr);

// The bands of levels[index].
inline LevelBands bands_of(Pyramid<int32_t>& pyramid, uint32_t index) {
    const uint32_t columns = pyramid.columns_at(index + 1), rows = pyramid.rows_at(index + 1);
    AnalysisLevel<int32_t>& level = pyramid.levels[index];
    return {{level.horizontal.data(), low_count(rows), high_count(columns)},
            {level.vertical.data(), high_count(rows), low_count(columns)},
            {level.diagonal.data(), high_count(rows), high_count(columns)}};
}

}  // namespace gim
