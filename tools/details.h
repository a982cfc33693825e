// The mesh of an image with displacements (gim/refine.h, "details"): fine where they are, as the samples elsewhere.
#pragma once

#include <cstdint>

#include "gim/decoder.hpp"
#include "tools/decoded.h"

namespace gim {

// Replaces the surface of a decoded image, at level 0, by the detailed one. Its grid has the samples that the mesh uses;
// others are undefined. Changes nothing if the file has no displacements.
gim_status add_details(Decoder& decoder, const Bytes& file, uint32_t index, DecodedImage* image);

}  // namespace gim
