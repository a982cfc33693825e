// What the index tells of errors and boxes, as the C interface hands it out.
#pragma once

#include <cstdint>

#include "format/container.h"
#include "gim/decoder.h"

namespace gim {

// Sets the errors of levels, has_boxes and box.
void tell_bounds(const Header& header, gim_info* info);

// Returns the box of an image; one without end if the file does not tell it.
gim_box image_box(const Header& header, uint32_t image);

}  // namespace gim
