#include "encoder/fit/coded_image.h"

#include "encoder/code/file_units.h"

namespace gim {

std::vector<Vec3> positions_of(const std::vector<float>& samples, const Units& units, const FitFrame& frame) {
    return frame.into(from_units(samples, units));
}

}  // namespace gim
