// The decoded mesh as an atlas of texels, and what of the mesh as read lies at each of them.
#pragma once

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "gim/nearest.h"
#include "tools/glb_meshes.h"
#include "tools/texture_atlas.h"

namespace gim::gltf {

class MeshAtlas {
  public:
    // Keeps a reference to the surface. geometry: level 0 of its .gim, with its places.
    MeshAtlas(const MeshSurface& surface, const GimGeometry& geometry, uint32_t threads);

    // All triangles, with texture coordinates and tangents.
    const PrimitiveArrays& arrays() const { return arrays_; }
    uint32_t primitive_of(uint32_t triangle) const { return labels_.empty() ? 0 : labels_[triangle / 2]; }

    // The size at which the primitives that are asked for have so many texels.
    AtlasSize size_for(double texels, const std::function<bool(uint32_t primitive)>& is_asked) const;

    struct Texel : AtlasTexel {
        SurfacePoint at;  // of the mesh as read, on the same primitive
    };
    // Finds them when a size is first asked for. O(texels log triangles).
    const std::vector<Texel>& texels(const AtlasSize& size);

  private:
    void locate(uint32_t primitive, const std::vector<AtlasTexel>& texels, std::vector<Texel>& found) const;

    const MeshSurface& surface_;
    const PrimitiveArrays arrays_;
    const uint32_t threads_;
    double aspect_ = 1;
    uint32_t least_width_ = 4;
    std::vector<uint8_t> labels_;
    std::map<std::pair<uint32_t, uint32_t>, std::vector<Texel>> located_;
};

// Places for the images of a .gim, by the area of their surfaces. Empty if there is only one image.
std::vector<AtlasPlace> places_of(const std::vector<DecodedImage>& images);

}  // namespace gim::gltf
