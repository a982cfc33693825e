#include "encoder/fit/prices.h"

#include <algorithm>
#include <cmath>

#include "encoder/base/parallel.h"

namespace gim {

namespace {

constexpr double kBits = 1;           // kBits and kNarrow were measured on bunny, horse, feline (spec/rationale.md)
constexpr double kNarrow = 0.3;       // of a step
constexpr float kPullsPerSample = 2;  // both surfaces are sampled
constexpr float kLeastArea = 0.05f;   // for preconditioning only

}  // namespace

Prices::Prices(const ImageBasis& basis, const ImageBasis::Coordinates& c, float quantizer, Free free,
               float tangential_pull)
    : price(c.size()), inverse(c.size()) {
    const auto ln2 = static_cast<float>(std::log(2.0));
    const float bit = 2 * ln2 / 12 * kPullsPerSample * quantizer * quantizer;
    parallel_blocks(c.size(), 16384, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            if ((free == Free::kNormals && basis.is_tangential(i)) || basis.is_copy(i)) continue;
            const float narrow = static_cast<float>(kNarrow) * basis.step(i);
            if (i >= basis.base_size())
                price[i] = bit * static_cast<float>(kBits) / ln2 / (c[i] * c[i] + narrow * narrow);
            const float pull = basis.is_tangential(i) ? tangential_pull : 1;
            const float area = std::max(kLeastArea, basis.relative_area(i));
            inverse[i] = 1 / (price[i] + basis.norm(i) * basis.norm(i) * kPullsPerSample * area * pull);
        }
    });
}

}  // namespace gim
