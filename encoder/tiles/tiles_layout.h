// Offers images of tiles to the drivers as the layout tiles, ready to be coded.
#pragma once

#include <memory>

#include "encoder/layout/layout_images.h"
#include "encoder/tiles/make_tiles.h"

namespace gim {

// mesh: the surface that the tiles were made from; copied where samples are fitted to a quantizer.
Result<std::unique_ptr<LayoutImages>> tiles_layout(MadeTiles made, const Mesh& mesh, const EncodeOptions& options);

}  // namespace gim
