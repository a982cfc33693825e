// The textures of a mesh: what its materials show, and through which coordinates.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "tools/glb_geometry.h"
#include "tools/gltf_material.h"
#include "tools/gltf_primitive.h"
#include "tools/texture_picture.h"

namespace gim::gltf {

// A texture of a primitive.
struct TextureSource {
    const RgbaPicture* picture = nullptr;  // null: white, for colours of vertices alone
    uint64_t image = 0;                    // of the file
    BaseColor use = {};                    // its coordinates
    TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
    double scale = 1;  // of a normal texture

    std::string texcoord_set() const { return "TEXCOORD_" + std::to_string(use.texcoord_set); }
    // Equal signatures mean equal values.
    std::string signature() const;
};

// One kind of texture of all primitives of a mesh.
struct TextureSlot {
    bool srgb = false, normal = false;
    bool with_colors = false;                           // of vertices: base colour
    bool is_opaque = false;                             // its alpha means nothing
    std::vector<std::optional<TextureSource>> sources;  // of each primitive

    std::string signature() const;
};

class TextureSlots {
  public:
    // Everything must outlive the object.
    TextureSlots(File& file, DracoMeshes& draco) : file_(file), draco_(draco) {}

    // The slots by their place in a material, as "/pbrMetallicRoughness/baseColorTexture". Throws a Failure that says why a
    // texture cannot be drawn anew.
    std::map<std::string, TextureSlot> of(const Json& mesh);

    // Which arrays a primitive wants: texture coordinates if it has textures or colours of vertices, tangents if it has a
    // normal texture.
    WantedArrays wanted(const Json& primitive);

    // All white is the same as no colours.
    bool has_colors(const Json& primitive);

  private:
    struct Picture {
        RgbaPicture rgba;
        std::string problem;  // empty: it could be read
    };
    const RgbaPicture& picture(uint64_t image);
    TextureSource source_of(const Json& info);
    const Json& material_of(const Json& primitive) const;

    File& file_;
    DracoMeshes& draco_;
    std::map<uint64_t, Picture> pictures_;  // by image of the file
};

inline const std::string kBaseColor = "/pbrMetallicRoughness/baseColorTexture";

}  // namespace gim::gltf
