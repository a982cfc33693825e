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

// One image per component, and the surface that it was made from.
struct Squares {
    std::vector<SquareImage> images;
    std::vector<Mesh> surfaces;
};

// One preference per component; nothing if it is not chosen yet.
using CutPreferences = std::vector<std::optional<CutPreference>>;

// The preferences of a mesh that is cut without a choice.
CutPreferences usual_cuts(const Mesh& mesh);

// Makes the images in the order of the components' first faces. Smaller components get smaller images. Adds its figures
// to the report. A component whose cut does not fit its side gets the next that holds it, up to `most_side`; a side
// above options.side becomes a warning. If the file must meet a PSNR or a size, the cuts of the largest components may be
// chosen among several by the bytes that their images cost. `preferences` is empty, or what an earlier call chose; on
// return it holds what was chosen.
Result<Squares> make_squares(const Mesh& mesh, const EncodeOptions& options, uint32_t most_side, StageClock& clock,
                             const Observer& observer, EncodeReport& report, CutPreferences& preferences);

}  // namespace gim
