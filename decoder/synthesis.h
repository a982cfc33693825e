// One level of the inverse wavelet: from an image of side h+1 and three bands to the image of side 2h+1.
// Samples are interleaved triples, so every loop runs over whole rows. Cost O(side^2).
#pragma once

#include <cstdint>

#include "format/band_code.h"
#include "format/lifting.h"

namespace gim {

// edge: quantizer steps of the bands high in one direction and in both; 1 for the reversible wavelet (unused).
struct BandSteps {
    float edge = 1, diagonal = 1;
};

// Numbers (of Sample's size) that synthesize needs as work space.
constexpr size_t synthesis_work_size(uint32_t side) { return (size_t{side} + 3) * 3; }

// low: (h+1)^2 triples. image: side^2 triples, may not overlap the inputs.
template <class Wavelet>
void synthesize(uint32_t side, const typename Wavelet::Sample* low, const LevelBands& bands, const BandSteps& steps,
                typename Wavelet::Sample* work, typename Wavelet::Sample* image);

}  // namespace gim
