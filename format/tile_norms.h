// Quantizer steps on a complex of tiles.  spec/gim-format.md, "Tiles".
#pragma once

#include <array>
#include <cstdint>

#include "format/container.h"
#include "format/detail_frame.h"
#include "format/tile_atlas.h"

namespace gim {

// L2 norms of the 5/3 synthesis functions on a regular grid, as kBandNorms.
inline constexpr std::array<BandNorms, kMostTileExponent> kSharpNorms = {{
    {1.5f, 1.03832798f, 0.71875f},
    {2.75f, 1.5922174f, 0.921875f},
    {5.375f, 2.91965992f, 1.5859375f},
    {10.6875f, 5.70278252f, 3.04296875f},
    {21.34375f, 11.3367128f, 6.02148438f},
    {42.671875f, 22.6389242f, 12.0107422f},
    {85.3359375f, 45.2605882f, 24.0053711f},
    {170.667969f, 90.5125452f, 48.0026855f},
    {341.333984f, 181.020775f, 96.0013428f},
    {682.666992f, 362.039391f, 192.000671f},
}};

inline const BandNorms& tile_norms(const TileShape& shape, uint32_t depth) {
    return shape.is_sharp ? kSharpNorms[depth - 1] : kBandNorms[depth - 1];
}

// The step of the base, against that of its norm, with 5/3. Between creases a surface has few details, so most of a file is
// its base, and details make up for a coarser one.
inline constexpr float kSharpBaseStep = 2;

inline float tile_base_step(const TileShape& shape, float quantizer) {
    const float step = quantizer / tile_norms(shape, shape.exponent).low;
    return shape.is_sharp ? kSharpBaseStep * step : step;
}

// depth: 1 for the finest details.
inline DetailSteps tile_steps_at(const TileShape& shape, const DetailCoding& coding, uint32_t depth) {
    DetailSteps steps = coding.steps_at(depth);
    const BandNorms& norms = tile_norms(shape, depth);
    steps.edge = coding.quantizer / norms.edge;
    steps.diagonal = coding.quantizer / norms.diagonal;
    return steps;
}

}  // namespace gim
