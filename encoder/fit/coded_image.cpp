#include "encoder/fit/coded_image.h"

namespace gim {

std::vector<Vec3> positions_of(const std::vector<float>& samples, const Units& units, const FitFrame& frame) {
    std::vector<Vec3> positions(samples.size() / 3);
    for (size_t i = 0; i < samples.size(); ++i) {
        positions[i / 3][static_cast<int>(i % 3)] =
            double{samples[i]} * double{units.step} + double{units.origin[i % 3]};
    }
    return frame.into(positions);
}

}  // namespace gim
