// Texture files of the mesh that is being read.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gim/encoder.h"

namespace gim {

// What a mesh reader collects its textures in. A texture that is missing or no image is a warning, never an error: the shape
// is there without it.
class Textures {
  public:
    static constexpr uint32_t kNoTexture = UINT32_MAX;

    // `folder`: that of the mesh file.
    explicit Textures(std::string folder) : folder_(std::move(folder)) {}

    // A file beside the mesh; the same name is read once. PNG, JPEG, TGA, BMP and what else stb_image knows.
    uint32_t load(std::string_view name);
    // The bytes of an image file. `name` is for the warning.
    uint32_t add(std::span<const uint8_t> file, const std::string& name);
    // The text of another file beside the mesh (an .mtl); empty with a warning where there is none.
    std::string read_text(std::string_view name);

    std::vector<TextureImage> images;
    std::vector<std::string> warnings;

  private:
    struct Known {
        std::string name;
        uint32_t index;
    };
    std::string path_of(std::string_view name) const;

    std::string folder_;
    std::vector<Known> known_;
};

}  // namespace gim
