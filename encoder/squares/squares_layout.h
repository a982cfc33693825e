// Offers the layout gim to the drivers: squares, one per component, ready to be coded.
#pragma once

#include <memory>

#include "encoder/layout/layout_images.h"
#include "encoder/squares/make_squares.h"

namespace gim {

// Lossy coding with EncodeOptions::fit kAuto fits the squares to their quantizer.
std::unique_ptr<LayoutImages> squares_layout(Squares squares, const EncodeOptions& options);

}  // namespace gim
