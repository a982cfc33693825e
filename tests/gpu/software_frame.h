// The reference: triangles drawn by the processor, by the same rules as a GPU. A pixel belongs to a triangle if its centre
// does; corners are rounded to a part of a pixel; of two triangles at an edge the one below or to the right has it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/gpu/frame_pixels.h"
#include "tools/gpu/shader_types.h"
#include "tools/gpu/surface_data.h"

namespace gim::test {

struct SoftTriangle {
    std::array<std::array<float, 3>, 3> positions;  // object
    std::array<std::array<double, 2>, 3> texels;    // in the normal map: column, row; whole numbers are centres
};

// Parts of a pixel that corners are rounded to: by most GPUs and Mesa's llvmpipe, and by SwiftShader.
inline constexpr uint32_t kUsualParts = 256, kSwiftShaderParts = 16;

class SoftwareFrame {
  public:
    // Each pixel has finer * finer samples; finer is odd, so that one of them is in the centre. Corners are rounded to
    // parts of pixels all the same.
    SoftwareFrame(uint32_t width, uint32_t height, uint32_t finer, std::array<uint8_t, 4> background,
                  uint32_t parts = kUsualParts);

    // Corners must lie in front of the eye. Depth outside of 0..1 is not drawn.
    void draw(std::span<const SoftTriangle> triangles, const SurfaceData& surface, const ShaderInstance& instance,
              const ShaderView& view);
    const FramePixels& pixels() const { return pixels_; }
    // Per sample: 1 if rounding may show something else: a hidden triangle is as close behind, or the triangle is so thin
    // that either face may be seen, or a back misses the sample by less than corners are rounded. That is so at silhouettes,
    // where front and back meet, and where a coarse surface passes through itself.
    std::vector<uint8_t> contested() const;

  private:
    struct Corner {
        int64_t x, y;  // 1/256 sample, y down
        double depth, distance;
    };
    Corner project(const std::array<float, 3>& position, const ShaderInstance& instance, const ShaderView& view) const;
    double depth_error(const std::array<Corner, 3>& corners, double doubled_area) const;
    template <class Shade>
    void fill(const std::array<Corner, 3>& corners, const Shade& shade);

    uint32_t finer_;
    int64_t rounding_;  // 1/256 sample, to which corners are rounded
    FramePixels pixels_;
    // Depths are known up to an error. Of what shows: the depth, the error, whether it is thin; of all that is hidden: the
    // smallest depth that it may have.
    std::vector<double> depth_, error_, hidden_;
    std::vector<uint8_t> is_thin_;
};

}  // namespace gim::test
