#include "tools/gpu/gl_frame.h"

#include <algorithm>

namespace gim {

Result<GlFrame> GlFrame::create(uint32_t width, uint32_t height) {
    GlFrame frame;
    frame.width_ = width;
    frame.height_ = height;
    frame.colour_ = make_texture(GL_RGBA8, width, height);
    frame.depth_ = make_texture(GL_DEPTH_COMPONENT32F, width, height);
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    frame.framebuffer_ = GlObject<delete_framebuffer>(name);
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, frame.colour_.name(), 0);
    glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, frame.depth_.name(), 0);
    if (glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return Error{Stage::kInput, "the driver cannot draw into a frame of this size"};
    return frame;
}

void GlFrame::begin(const std::array<float, 4>& background) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_));
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDisable(GL_CULL_FACE);
    glFrontFace(GL_CCW);
    const float farthest = 1;
    glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, 0, background.data());
    glClearNamedFramebufferfv(framebuffer_.name(), GL_DEPTH, 0, &farthest);
}

FramePixels GlFrame::read() const {
    FramePixels pixels{width_, height_, std::vector<uint8_t>(size_t{4} * width_ * height_)};
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_), GL_RGBA, GL_UNSIGNED_BYTE,
                 pixels.rgba.data());
    // OpenGL begins with the lowest row.
    const size_t row = size_t{4} * width_;
    for (size_t y = 0; y < height_ / 2; ++y)
        std::swap_ranges(pixels.rgba.begin() + static_cast<ptrdiff_t>(y * row),
                         pixels.rgba.begin() + static_cast<ptrdiff_t>((y + 1) * row),
                         pixels.rgba.begin() + static_cast<ptrdiff_t>((height_ - 1 - y) * row));
    return pixels;
}

}  // namespace gim
