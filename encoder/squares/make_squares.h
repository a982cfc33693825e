// The layout gim: one square image per connected component.
#pragma once

#include <optional>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/squares/make_square.h"
#include "encoder/squares/square_image.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// One image per component, and the surface that it was made of.
struct Squares {
    std::vector<SquareImage> images;
    std::vector<Mesh> surfaces;
};

// Per component; nothing: not chosen yet.
using CutPreferences = std::vector<std::optional<CutPreference>>;

// In the order of the components' first faces; smaller components get smaller images. Adds its figures to the report.
// Cuts of the largest components may be chosen among several by what their images cost, where files are to meet a PSNR
// or a size. preferences: empty, or what an earlier call has chosen; tells what was chosen.
Result<Squares> make_squares(const Mesh& mesh, const EncodeOptions& options, StageClock& clock,
                             const Observer& observer, EncodeReport& report, CutPreferences& preferences);

}  // namespace gim
