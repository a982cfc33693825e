#include "encoder/fit/fit_codec.h"

namespace gim {

void FitCodec::average_glued(std::vector<float>& image) const {
    for (const auto& members : gluing_.shared) {
        for (size_t k = 0; k < 3; ++k) {
            float sum = 0;
            for (const uint32_t v : members) sum += image[3 * size_t{v} + k];
            for (const uint32_t v : members) image[3 * size_t{v} + k] = sum / static_cast<float>(members.size());
        }
    }
}

}  // namespace gim
