#include "tools/gpu/gl_object.h"

#include <algorithm>

namespace gim {

void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }
void delete_texture(GLuint name) { glDeleteTextures(1, &name); }
void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }
void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
void delete_program(GLuint name) { glDeleteProgram(name); }

GlBuffer::GlBuffer(size_t size) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    object_ = GlObject<delete_buffer>(name);
    reserve(std::max<size_t>(size, 4));  // a buffer of no bytes cannot be bound
}

void GlBuffer::reserve(size_t size) {
    if (size <= size_) return;
    size_ = size;
    glNamedBufferData(object_.name(), static_cast<GLsizeiptr>(size), nullptr, GL_DYNAMIC_DRAW);
}

void GlBuffer::write_bytes(const void* bytes, size_t size) {
    reserve(size);
    if (size > 0) glNamedBufferSubData(object_.name(), 0, static_cast<GLsizeiptr>(size), bytes);
}

GlTexture make_texture(GLenum format, uint32_t width, uint32_t height) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, 1, format, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    return GlTexture(name);
}

GlVertexArray make_vertex_array() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return GlVertexArray(name);
}

Result<void> check_gl(const std::string& what) {
    const GLenum first = glGetError();
    if (first == GL_NO_ERROR) return {};
    while (glGetError() != GL_NO_ERROR) {
    }
    return Error{Stage::kInput, what + ": OpenGL says error " + std::to_string(first)};
}

}  // namespace gim
