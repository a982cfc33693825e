// The prices of coordinates in the fit to the codec (fit_coded.h), and their scales for its conjugate gradients.
#pragma once

#include <vector>

#include "encoder/fit/image_basis.h"

namespace gim {

enum class Free { kAll, kNormals };

struct Prices {
    // Per coordinate. inverse: about 1 / (price + curvature of the distances), 0 if held; only affects convergence.
    std::vector<float> price, inverse;

    // c: the current coordinates. tangential_pull: the part of a distance's pull along the surface that `inverse` counts.
    Prices(const ImageBasis& basis, const ImageBasis::Coordinates& c, float quantizer, Free free,
           float tangential_pull);
};

}  // namespace gim
