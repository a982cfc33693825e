// Adds fine details to a .gim file: a picture becomes displacements along the normals, finer than the file's samples.
// Maximo, Velho, Siqueira. Adaptive Multi-chart and Multiresolution Mesh Representation. 2013, section 5.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "gim/encoder.h"

namespace gim {

struct HeightPicture {
    uint32_t width = 0, height = 0;
    std::vector<float> heights;  // width * height, 0 .. 1, top row first
};

struct EmbossOptions {
    // The middle of the picture: a point in space, from which the nearest one of the surface is taken, or texture
    // coordinates of the image.
    struct TextureCoordinates {
        double u = 0, v = 0;
    };
    std::variant<std::array<double, 3>, TextureCoordinates> at;
    uint32_t image = 0;
    double size = 0;                         // of the picture's longer side on the surface, object units; above 0
    double depth = 0;                        // how far a height of 1 displaces, object units; below 0 engraves; not 0
    std::array<double, 3> up = {0, 0, 1};    // the picture's upper side lies in this direction
    double turn = 0;                         // degrees, counter-clockwise seen from outside
    std::optional<uint32_t> texel_exponent;  // 2^this texels a sample; without: about one for each pixel
};

struct Embossed {
    std::vector<uint8_t> bytes;  // the file, with its displacements
    uint32_t texel_exponent = 0;
    uint64_t displaced_texels = 0;
    uint64_t plane_bytes = 0;
    double spacing = 0;  // of the texels under the picture, object units
};

// Returns the file with displacements; those that it has are kept and added to. Layouts `gim` and `tiles`.
// The picture is laid on the surface by an exponential map, so it should be small against what it lies on. It ends where the
// surface ends. Cost: O(samples + texels).
// Errors: a file that does not decode, a layout without tiles, options out of range, a place that is not on the surface.
Result<Embossed> emboss(std::span<const uint8_t> file, const HeightPicture& picture, const EmbossOptions& options);

}  // namespace gim
