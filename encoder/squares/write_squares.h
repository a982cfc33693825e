// Writes squares as a file holds them: sidebands, and one stream for each image and level. See spec/gim-format.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/code/file_writer.h"
#include "encoder/squares/square_image.h"

namespace gim {

// There must be at least one image. Positions must be finite, and sidebands must close the finest level. Otherwise an
// Error names the image.
Result<FileWriter> squares_writer(std::span<const SquareImage> images, const CodingParameters& parameters);
Result<std::vector<uint8_t>> write_squares(std::span<const SquareImage> images, const CodingParameters& parameters);

// Returns the units of positions and details in a lossy file of these images. Leaves the quantizer out.
Units units_of(std::span<const SquareImage> images, uint32_t bits);

// Returns the seams as a file has them. The image's sideband must be valid.
SeamTable file_seams(const SquareImage& image);

}  // namespace gim
