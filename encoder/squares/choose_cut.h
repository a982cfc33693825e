// Chooses among several cuts of a surface, and the maps that go with them, by what their images cost.
//
// Gu 2002 (section 3.2) judges a cut by the stretch of its map. That is a good guide on the way to a cut; but of cuts that were
// sought with different preferences the least stretched is often not the one that codes best (spec/rationale.md).
#pragma once

#include <optional>

#include "encoder/squares/make_square.h"

namespace gim {

// For files that are fitted to a PSNR or a size.
bool may_choose_chart(const EncodeOptions& options);

struct ChosenChart {
    SingleChart chart;
    CutPreference preference;
};
// In: a clean connected mesh, options of which may_choose_chart() is true. Nothing where no cut leads to an image of that side.
// The same for any number of threads. Cost: about that of six images, and of six short fits.
std::optional<ChosenChart> choose_chart(const Mesh& mesh, const EncodeOptions& options, StageClock& clock);

}  // namespace gim
