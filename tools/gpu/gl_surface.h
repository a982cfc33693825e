// What both ways of drawing read: surfaces, instances, patches, the view.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/gpu/gl_object.h"
#include "tools/gpu/shader_types.h"
#include "tools/gpu/split_patches.h"
#include "tools/gpu/surface_data.h"

namespace gim {

class GlSurface {
  public:
    // Copies the surfaces to the GPU. ShaderInstance.domain is their number.
    explicit GlSurface(const SurfaceStore& store);

    void set_instances(std::span<const ShaderInstance> instances) { instances_.write(instances); }
    // Patches and the instance of each.
    void set_patches(const InstancedPatches& patches);
    // Patch count and capacity are filled in by the way of drawing.
    void set_view(const ShaderView& view) { view_ = view; }

    uint32_t patch_count() const { return patch_count_; }
    // Where batches end whose vertices 16 bits can number, even if cells are halved twice. The llvmpipe of Mesa 22.3 leaves
    // out parts of larger batches of tessellated patches.
    const std::vector<uint32_t>& patch_batches() const { return batches_; }
    // Binds all for shaders. capacity: of triangles, for the expansion.
    void bind(uint32_t capacity);

  private:
    GlBuffer domains_, positions_, instances_, patches_, patch_instances_, view_buffer_;
    GlTexture normals_;
    ShaderView view_;
    std::vector<uint32_t> batches_;
    uint32_t patch_count_ = 0;
};

}  // namespace gim
