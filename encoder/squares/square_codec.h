// The codec of squares, as the fit sees it.
#pragma once

#include <cstdint>

#include "encoder/fit/fit_coded.h"
#include "format/seam.h"

namespace gim {

// side: of the image. seams: of the file; mates share their details. Copied.
MakeFitCodec square_codec(uint32_t side, const SeamTable& seams);

}  // namespace gim
