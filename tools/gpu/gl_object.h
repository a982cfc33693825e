// Buffers and textures of OpenGL that go when their owners do.
#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "gim/encoder.h"

namespace gim {

// The number of an object of OpenGL, with the function that deletes it.
template <void (*kDelete)(GLuint)>
class GlObject {
  public:
    GlObject() = default;
    explicit GlObject(GLuint name) : name_(name) {}
    GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~GlObject() {
        if (name_ != 0) kDelete(name_);
    }
    GLuint name() const { return name_; }

  private:
    GLuint name_ = 0;
};

void delete_buffer(GLuint name);
void delete_texture(GLuint name);
void delete_vertex_array(GLuint name);
void delete_framebuffer(GLuint name);
void delete_program(GLuint name);

using GlTexture = GlObject<delete_texture>;
using GlVertexArray = GlObject<delete_vertex_array>;

class GlBuffer {
  public:
    explicit GlBuffer(size_t size = 0);

    // Grows if need be. Contents are lost then.
    void reserve(size_t size);
    template <class T>
    void write(std::span<const T> values) {
        write_bytes(values.data(), values.size_bytes());
    }
    template <class T>
    void read(std::span<T> values) const {
        glGetNamedBufferSubData(object_.name(), 0, static_cast<GLsizeiptr>(values.size_bytes()), values.data());
    }
    void bind(GLenum target, GLuint binding) const { glBindBufferBase(target, binding, object_.name()); }
    GLuint name() const { return object_.name(); }
    size_t size() const { return size_; }

  private:
    void write_bytes(const void* bytes, size_t size);

    GlObject<delete_buffer> object_;
    size_t size_ = 0;
};

GlTexture make_texture(GLenum format, uint32_t width, uint32_t height);
GlVertexArray make_vertex_array();

// Success if OpenGL has seen no error since the last call.
Result<void> check_gl(const std::string& what);

}  // namespace gim
