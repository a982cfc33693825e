// Draws patches by a compute shader and one indirect draw, as engines on WebGPU and Vulkan do.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/gpu/gl_program.h"
#include "tools/gpu/gl_surface.h"

namespace gim {

class GlExpand {
  public:
    // capacity: triangles that there is room for, 16 bytes each.
    static Result<GlExpand> create(uint32_t capacity);

    // Turns the surface's patches into triangles. They stay until the next call, so that a view that turns alone needs
    // no call, unless instances choose their fineness by the screen.
    void expand(GlSurface& surface);
    // Draws the triangles into the current frame.
    void draw(GlSurface& surface) const;

    // Takes triangles as they are, in place of expanding patches: three samples (row << 16 | column) and the instance.
    void set_triangles(std::span<const std::array<uint32_t, 4>> triangles);

    // Triangles that the last expansion needed; those beyond the capacity are not drawn. Waits for the GPU.
    uint32_t needed() const;
    void set_capacity(uint32_t capacity);
    uint32_t capacity() const { return capacity_; }
    // The triangles: three samples (row << 16 | column) and the instance. Waits for the GPU.
    std::vector<std::array<uint32_t, 4>> read_triangles() const;

  private:
    GlExpand(GlProgram expand, GlProgram draw) : expand_(std::move(expand)), draw_(std::move(draw)) {}

    GlProgram expand_, draw_;
    GlBuffer triangles_, command_;
    GlVertexArray no_vertices_ = make_vertex_array();
    uint32_t capacity_ = 0;
};

}  // namespace gim
