// Textures of a mesh, drawn anew for the texture coordinates of its .gim: one picture for each kind of texture, which all
// primitives of the mesh share.
#pragma once

#include "tools/glb_atlas.h"
#include "tools/glb_document.h"
#include "tools/glb_texture_slots.h"

namespace gim::gltf {

class TextureBaker {
  public:
    // Everything must outlive the object.
    TextureBaker(File& file, DracoMeshes& draco, GlbDocument& document, uint32_t threads)
        : file_(file), draco_(draco), document_(document), slots_(file, draco), threads_(threads) {}

    // Throws a Failure that says why the textures of a mesh cannot be drawn anew: then the mesh has to stay.
    void check(const Json& mesh) { (void)slots_.of(mesh); }
    WantedArrays wanted(const Json& primitive) { return slots_.wanted(primitive); }

    // Returns for each primitive of a mesh the material of the document that it has from now on; nothing if it keeps its
    // own. mesh: of the file. geometry: level 0, with its places. O(texels log triangles).
    std::vector<std::optional<size_t>> bake(const Json& mesh, const MeshSurface& surface, const GimGeometry& geometry);

  private:
    struct SlotReader;
    size_t draw(const TextureSlot& slot, const Json& mesh, const MeshSurface& surface, MeshAtlas& atlas);
    size_t add_texture(const std::vector<uint8_t>& pixels, const AtlasSize& size, size_t channels, bool as_jpeg);
    size_t material_with(const Json& primitive, size_t index, const std::map<std::string, TextureSlot>& slots,
                         const std::map<std::string, size_t>& textures);

    File& file_;
    DracoMeshes& draco_;
    GlbDocument& document_;
    TextureSlots slots_;
    const uint32_t threads_;
    std::optional<size_t> sampler_;
};

}  // namespace gim::gltf
