// Squares as a file holds them: sidebands, and one stream for each image and level.  spec/gim-format.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/code/file_writer.h"
#include "encoder/squares/square_image.h"

namespace gim {

// Images: at least one, finite positions, sidebands that close the finest level. Else an Error names the image.
Result<FileWriter> squares_writer(std::span<const SquareImage> images, const CodingParameters& parameters);
Result<std::vector<uint8_t>> write_squares(std::span<const SquareImage> images, const CodingParameters& parameters);

// What positions and details of a lossy file of these images are counted in. The quantizer is left out.
Units units_of(std::span<const SquareImage> images, uint32_t bits);

// The seams as a file has them. The image's sideband is in order.
SeamTable file_seams(const SquareImage& image);

}  // namespace gim
