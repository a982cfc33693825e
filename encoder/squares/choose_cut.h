// Chooses among several cuts of a surface, with their maps, by the bytes that their images cost.
//
// Gu 2002 (section 3.2) judges a cut by the stretch of its map. Stretch guides the search for one cut well. But among
// cuts found with different preferences, the least stretched often does not code best (spec/rationale.md).
#pragma once

#include <optional>
#include <span>

#include "encoder/squares/make_square.h"

namespace gim {

// Returns the preferences to choose from; the usual one is the first.
std::span<const CutPreference> cut_preferences();

// Returns true if the file is fitted to a PSNR or a size.
bool may_choose_cut(const EncodeOptions& options);

struct ChosenCut {
    MadeSquare square;
    CutPreference preference;
};
// `mesh` must be clean and connected, and may_choose_cut(options) true. Returns nothing if no cut leads to an image
// of that side. The result is the same for any number of threads. Cost: about that of six images and six short fits.
std::optional<ChosenCut> choose_cut(const Mesh& mesh, const EncodeOptions& options, StageClock& clock);

}  // namespace gim
