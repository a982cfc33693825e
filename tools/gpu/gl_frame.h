// A picture with depth that OpenGL draws into.
#pragma once

#include <array>
#include <cstdint>

#include "tools/gpu/frame_pixels.h"
#include "tools/gpu/gl_object.h"

namespace gim {

class GlFrame {
  public:
    static Result<GlFrame> create(uint32_t width, uint32_t height);

    // Draws go here from now on; depth is 0..1 and the nearer one wins. Both faces are drawn.
    void begin(const std::array<float, 4>& background) const;
    // Waits for the GPU.
    FramePixels read() const;

  private:
    GlFrame() = default;

    uint32_t width_ = 0, height_ = 0;
    GlTexture colour_, depth_;
    GlObject<delete_framebuffer> framebuffer_;
};

}  // namespace gim
