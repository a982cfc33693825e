// The layout gim, from images to a coding job.
#pragma once

#include "encoder/finish_encoding.h"
#include "encoder/squares/square_images.h"

namespace gim {

// Describes the images in the report as well. Lossy coding of EncodeOptions::fit kAuto fits them to their quantizer.
CodingJob code_squares(SquareImages squares, const EncodeOptions& options, StageClock& clock, EncodeReport& report);

}  // namespace gim
