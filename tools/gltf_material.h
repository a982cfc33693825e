// Base colours: material factors, vertex colours, textures and their transforms.
#pragma once

#include <map>

#include "tools/gltf_file.h"
#include "tools/textures.h"

namespace gim::gltf {

// Loads the image of a texture when it is first needed. An image that is missing, damaged or of an unknown kind gives a
// warning, since the shape does not need it.
class Pictures {
  public:
    // The context of the file has textures.
    explicit Pictures(File& file) : file_(file) {}

    // Textures::kNoTexture if there is no such image.
    uint32_t load(uint64_t texture);

  private:
    uint32_t load_image(uint64_t image);

    File& file_;
    std::map<uint64_t, uint32_t> textures_loaded_;  // by glTF texture
    std::map<uint64_t, uint32_t> images_loaded_;    // by glTF image
};

// The base colour of a material, whose texture is `texture` of the glTF file.
struct BaseColor {
    std::array<double, 3> factor = {1, 1, 1};  // linear
    std::optional<uint64_t> texture;
    uint64_t texcoord_set = 0;
    // KHR_texture_transform, by rows: u' = to_u . (u, v, 1)
    std::array<double, 3> to_u = {1, 0, 0};
    std::array<double, 3> to_v = {0, 1, 0};
};

// Sets texture, set of coordinates and transform from a texture info.
void read_texture(const Json& info, BaseColor& color);

// The default material if the primitive has none.
BaseColor base_color(const Json& root, const Json& primitive);

// From linear light, clamped to 0..1.
float to_srgb(double linear);

}  // namespace gim::gltf
