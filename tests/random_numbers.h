// Random numbers that are the same on every platform.
#pragma once

#include <cstdint>
#include <random>

namespace gim {

using Random = std::mt19937_64;

inline double between(Random& random, double least, double most) {
    return least + (most - least) * (static_cast<double>(random() >> 11) * 0x1p-53);
}
inline uint32_t number_between(Random& random, uint32_t least, uint32_t most) {
    return least + static_cast<uint32_t>(random() % (most - least + 1));
}

}  // namespace gim
