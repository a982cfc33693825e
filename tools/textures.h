// The texture files of the mesh that is being read.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gim/encoder.h"
#include "tools/memory_budget.h"

namespace gim {

// Collects the textures of a mesh. A texture that is missing or not an image gives a warning, never an error, because
// the shape does not need it.
class Textures {
  public:
    static constexpr uint32_t kNoTexture = UINT32_MAX;

    // `folder`: the folder of the mesh file.
    explicit Textures(std::string folder) : folder_(std::move(folder)) {}

    // Pictures whose pixels go over the budget are left out, with a warning.
    void limit_memory(MemoryBudget* memory) { memory_ = memory; }

    // Reads a file beside the mesh, each name once: PNG, JPEG, TGA, BMP and whatever else stb_image reads.
    uint32_t load(std::string_view name);
    // Adds the bytes of an image file. The warning uses `name`.
    uint32_t add(std::span<const uint8_t> file, const std::string& name);
    // True if there is a file of this name beside the mesh.
    bool exists(std::string_view name) const;
    // Returns the text of another file beside the mesh (an .mtl). If there is none, it is empty, with a warning.
    std::string read_text(std::string_view name);

    std::vector<TextureImage> images;
    std::vector<std::string> warnings;

  private:
    struct Known {
        std::string name;
        uint32_t index;
    };
    std::string path_of(std::string_view name) const;
    Result<std::vector<uint8_t>> read(std::string_view name) const;

    std::string folder_;
    MemoryBudget* memory_ = nullptr;
    std::vector<Known> known_;
};

}  // namespace gim
