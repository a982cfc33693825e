// The codec of tiles, as the fit to the codec sees it (encoder/fit/fit_codec.h).
#pragma once

#include <memory>

#include "encoder/base/result.h"
#include "encoder/fit/fit_codec.h"
#include "encoder/tiles/tile_image.h"

namespace gim {

// The fit's image is the atlas of the tiles in the image's order (format/tile_atlas.h). Positions do not matter here.
Result<std::unique_ptr<FitCodec>> tile_fit_codec(const TileImage& image);

// Sets the positions of the image from those of its atlas. Samples that tiles share are equal there.
Result<void> take_positions(const std::vector<Vec3>& atlas, TileImage& image);

}  // namespace gim
