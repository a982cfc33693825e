// One level of the inverse wavelet: from an image of half the size and three bands to the image.
// Samples are interleaved triples, so every loop runs over whole rows. Cost O(samples).
#pragma once

#include <cstdint>
#include <type_traits>

#include "decoder/pyramid/rows.h"
#include "format/band_code.h"
#include "format/detail_frame.h"
#include "format/lifting.h"
#include "format/rim.h"

namespace gim {

// Numbers that synthesize needs as work space.
constexpr size_t synthesis_work_size(uint32_t columns) { return (size_t{columns} + 4) * 3; }

// columns, rows: of the image, at least 2. low: low_count(rows) x low_count(columns) triples. image: rows x columns
// triples, apart from all inputs. steps, rim: only for the 9/7.
void synthesize(const RowLifting& lifting, uint32_t columns, uint32_t rows, const Number* low, const LevelBands& bands,
                const DetailSteps& steps, Number* work, Number* image, const SharedRim& rim = {});

// The same for numbers of a known type.
template <class Wavelet>
void synthesize(uint32_t columns, uint32_t rows, const typename Wavelet::Sample* low, const LevelBands& bands,
                const DetailSteps& steps, typename Wavelet::Sample* work, typename Wavelet::Sample* image,
                const SharedRim& rim = {}) {
    synthesize(RowLifting(std::is_integral_v<typename Wavelet::Sample>), columns, rows,
               reinterpret_cast<const Number*>(low), bands, steps, reinterpret_cast<Number*>(work),
               reinterpret_cast<Number*>(image), rim);
}

}  // namespace gim
