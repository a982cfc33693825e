// Turns displacements of all images of a file into the payload of its DISP chunk.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/code/assemble_file.h"

namespace gim {

// The displacements of one image.
struct Displacements {
    uint8_t exponent = 0;       // as the chunk says it (spec/gim-format.md, "Planes")
    uint32_t width = 0;         // of the plane
    std::vector<float> values;  // rows of triples, in units
};

// The file must be intact. quantizer: in units. Values of one surface point become equal. O(texels).
Result<CodedPlane> code_displacements(std::span<const uint8_t> file, std::span<const Displacements> images,
                                      float quantizer);

}  // namespace gim
