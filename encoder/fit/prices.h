// What coordinates cost in the fit to the codec (fit_coded.h), and how its conjugate gradients scale them.
#pragma once

#include <vector>

#include "encoder/fit/detail_basis.h"

namespace gim {

enum class Free { kAll, kNormals };

struct Prices {
    // Per coordinate: the price; 1 / (price + curvature of the distances, about), 0 where held. The second one only decides
    // how fast the fit converges.
    std::vector<float> price, inverse;

    // c: the coordinates now.
    Prices(const DetailBasis& basis, const DetailBasis::Coordinates& c, float quantizer, Free free);
};

}  // namespace gim
