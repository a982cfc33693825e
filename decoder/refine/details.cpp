#include "decoder/refine/details.h"

namespace gim {
namespace {

float between(float a, float b, float t) { return a + (b - a) * t; }

class Displacing {
  public:
    Displacing(const QuadDomain& coarse, const QuadDomain& fine, const DisplacementImage& image, const float* positions,
               float* detailed)
        : coarse_(coarse),
          fine_(fine),
          image_(image),
          positions_(positions),
          detailed_(detailed),
          parts_(1u << image.finer) {}

    // A sample of several tiles has what its first place says, so the last place comes first.
    void run() {
        const uint32_t n = fine_.shape().intervals;
        for (uint32_t t = fine_.shape().tiles; t-- > 0;) {
            for (uint32_t row = n + 1; row-- > 0;) {
                for (uint32_t column = n + 1; column-- > 0;) set(t, row, column);
            }
        }
    }

  private:
    const float* displacement(uint32_t tile, uint32_t row, uint32_t column) const {
        const size_t y = size_t{coarse_.shape().row_of(tile)} * parts_ + row;
        const size_t x = size_t{coarse_.shape().column_of(tile)} * parts_ + column;
        return image_.values + 3 * (y * image_.width + x);
    }
    const float* position(uint32_t tile, uint32_t row, uint32_t column) const {
        return positions_ + 3 * size_t{coarse_.vertex_at(tile, row, column)};
    }

    void set(uint32_t tile, uint32_t row, uint32_t column) {
        const uint32_t n = coarse_.shape().intervals, r = row / parts_, c = column / parts_;
        const uint32_t below = r < n ? r + 1 : n, right = c < n ? c + 1 : n;
        const float s = static_cast<float>(row % parts_) / static_cast<float>(parts_);
        const float t = static_cast<float>(column % parts_) / static_cast<float>(parts_);
        const float *p00 = position(tile, r, c), *p01 = position(tile, r, right);
        const float *p10 = position(tile, below, c), *p11 = position(tile, below, right);
        const float* add = displacement(tile, row, column);
        float* to = detailed_ + 3 * size_t{fine_.vertex_at(tile, row, column)};
        for (int k = 0; k < 3; ++k) to[k] = between(between(p00[k], p01[k], t), between(p10[k], p11[k], t), s) + add[k];
    }

    const QuadDomain &coarse_, &fine_;
    const DisplacementImage& image_;
    const float* positions_;
    float* detailed_;
    uint32_t parts_;
};

}  // namespace

void displace(const QuadDomain& coarse, const QuadDomain& fine, const DisplacementImage& image, const float* positions,
              float* detailed) {
    Displacing(coarse, fine, image, positions, detailed).run();
}

}  // namespace gim
