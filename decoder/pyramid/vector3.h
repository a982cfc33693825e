// Binary32 arithmetic on triples, in the order that the spec prescribes.
#pragma once

#include <cmath>

namespace gim {

inline float squared_distance(const float* a, const float* b) {
    const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

inline void cross(const float* u, const float* v, float* n) {
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
}

// Scales n to unit length. Zero stays zero.
inline void normalize(float* n) {
    const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; ++k) n[k] = length > 0.0f ? n[k] / length : 0.0f;
}

}  // namespace gim
