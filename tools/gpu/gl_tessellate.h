// Draws patches by the tessellator (Maximo, Velho, Siqueira 2013, section 4.4).
#pragma once

#include "tools/gpu/gl_program.h"
#include "tools/gpu/gl_surface.h"

namespace gim {

// Borders that a tessellator takes have at most 2^6 edges: add_patches splits larger patches.
inline constexpr uint32_t kTessellatorEdges = 6;

class GlTessellate {
  public:
    static Result<GlTessellate> create();
    // Draws the surface's patches into the current frame.
    void draw(GlSurface& surface) const;

  private:
    explicit GlTessellate(GlProgram program) : program_(std::move(program)) {}

    GlProgram program_;
    GlVertexArray no_vertices_ = make_vertex_array();
};

}  // namespace gim
