// Image -> wavelet bands: the mirror of decoder/synthesis.h.  spec/gim-format.md, "Wavelets".
// In:  side*side interleaved triples, integers (reversible 5/3) or floats in units (9/7).
// Out: all bands down to a 2x2 base. Cost O(side^2). Deterministic.
#pragma once

#include <cstdint>
#include <vector>

#include "format/band_code.h"
#include "format/lifting.h"

namespace gim {

// The bands that lead from side 2^(e-1)+1 to side 2^e+1, as triples.
template <class Sample>
struct AnalysisLevel {
    std::vector<Sample> horizontal, vertical, diagonal;
};

template <class Sample>
struct Pyramid {
    uint32_t side = 0;
    std::vector<Sample> base;                   // 2x2 triples
    std::vector<AnalysisLevel<Sample>> levels;  // levels[e-1], e = 1 .. exponent of the side
};

template <class Wavelet>
Pyramid<typename Wavelet::Sample> analyse(std::vector<typename Wavelet::Sample> image, uint32_t side);

}  // namespace gim
