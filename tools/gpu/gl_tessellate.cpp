#include "tools/gpu/gl_tessellate.h"

namespace gim {

Result<GlTessellate> GlTessellate::create() {
    // Drivers may leave the tessellator without storage buffers.
    for (const GLenum limit :
         {GL_MAX_TESS_CONTROL_SHADER_STORAGE_BLOCKS, GL_MAX_TESS_EVALUATION_SHADER_STORAGE_BLOCKS}) {
        GLint blocks = 0;
        glGetIntegerv(limit, &blocks);
        if (blocks < 5) return Error{Stage::kInput, "the driver has too few storage buffers for tessellation shaders"};
    }
    Result<GlProgram> program = GlProgram::build({"patch.vert", "patch.tesc", "patch.tese", "surface.frag"});
    if (!program.ok()) return program.error();
    return GlTessellate(std::move(program.value()));
}

void GlTessellate::draw(GlSurface& surface) const {
    surface.bind(0);
    program_.use();
    glBindVertexArray(no_vertices_.name());
    glPatchParameteri(GL_PATCH_VERTICES, 1);
    GLint first = 0;
    for (const uint32_t end : surface.patch_batches()) {
        glDrawArrays(GL_PATCHES, first, static_cast<GLsizei>(end) - first);
        first = static_cast<GLint>(end);
    }
}

}  // namespace gim
