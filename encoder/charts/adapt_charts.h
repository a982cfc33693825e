// Adapts the sample density of charts to the shape (image/density.h).
#pragma once

#include <vector>

#include "encoder/base/result.h"
#include "encoder/charts/atlas.h"
#include "encoder/image/density.h"

namespace gim {

// Maps the charts again, denser where evenly sampled charts err. Keeps the new maps only if `samples` samples then err
// less. The charts need not be packed, because each is sampled by itself. A chart keeps its map if its new border would
// cross itself.
// Out: the importance used, per face of the surface. Empty if the old maps were kept; `atlas` is then unchanged.
// Cost: one more parametrization, and two closest points per vertex.
Result<std::vector<double>> adapt_charts(const Mesh& mesh, uint32_t samples, const DensityOptions& options,
                                         const ChartParametrizeOptions& parametrize, Atlas& atlas,
                                         const Progress& progress = {});

// The options for adapt_charts(). Measured after a loose fit: +0.9 to +1.4 dB over even samples on horse, feline,
// dragon and gargoyle. Full strength or less smoothing gains as much on three of them and loses on the fourth.
inline constexpr DensityOptions kChartDensity{.strength = 0.9, .contrast = 200, .smoothing = 15};

}  // namespace gim
