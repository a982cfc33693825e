#include "tools/gpu/gl_surface.h"

#include <algorithm>

namespace gim {
namespace {

constexpr uint32_t kMostVertices = 65535;  // of a batch

}  // namespace

GlSurface::GlSurface(const SurfaceStore& store)
    : normals_(make_texture(GL_RGBA8_SNORM, store.map_width, store.map_height)) {
    domains_.write(std::span(store.domains));
    positions_.write(std::span(store.positions));
    glTextureSubImage2D(normals_.name(), 0, 0, 0, static_cast<GLsizei>(store.map_width),
                        static_cast<GLsizei>(store.map_height), GL_RGBA, GL_BYTE, store.normals.data());
    glTextureParameteri(normals_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(normals_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(normals_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(normals_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void GlSurface::set_patches(const InstancedPatches& patches) {
    static_assert(sizeof(gim_patch) == 8);
    patch_count_ = static_cast<uint32_t>(patches.patches.size());
    patches_.write(std::span(patches.patches));
    patch_instances_.write(std::span(patches.instances));
    batches_.clear();
    uint32_t vertices = 0;
    for (uint32_t i = 0; i < patch_count_; ++i) {
        const gim_patch& p = patches.patches[i];
        const uint32_t rows = (1u << std::min<uint32_t>(p.side, p.inside + 2u)) + 1;
        const uint32_t all = rows * rows + 4 * rows;  // finer borders have up to twice as many
        if (vertices + all > kMostVertices && i > 0) {
            batches_.push_back(i);
            vertices = 0;
        }
        vertices += all;
    }
    if (patch_count_ > 0) batches_.push_back(patch_count_);
}

void GlSurface::bind(uint32_t capacity) {
    view_.patch_count = patch_count_;
    view_.capacity = capacity;
    view_buffer_.write(std::span<const ShaderView>(&view_, 1));
    view_buffer_.bind(GL_UNIFORM_BUFFER, 0);
    const GlBuffer* const storage[] = {&patches_, &patch_instances_, &instances_, &domains_, &positions_};
    for (GLuint i = 0; i < 5; ++i) storage[i]->bind(GL_SHADER_STORAGE_BUFFER, i);
    glBindTextureUnit(0, normals_.name());
}

}  // namespace gim
