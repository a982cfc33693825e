#include "encoder/surface/space_order.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace gim {

namespace {

constexpr int kBits = 20;  // of each coordinate

// Moves bit i of the low 21 bits to bit 3 i.
uint64_t spread(uint64_t x) {
    x = (x | (x << 32)) & 0x001f'0000'0000'ffffu;
    x = (x | (x << 16)) & 0x001f'0000'ff00'00ffu;
    x = (x | (x << 8)) & 0x100f'00f0'0f00'f00fu;
    x = (x | (x << 4)) & 0x10c3'0c30'c30c'30c3u;
    return (x | (x << 2)) & 0x1249'2492'4924'9249u;
}

uint64_t morton_code(const Vec3& place) {
    uint64_t code = 0;
    for (int k = 0; k < 3; ++k) code |= spread(static_cast<uint64_t>(place[k])) << k;
    return code;
}

}  // namespace

Mesh in_space_order(Mesh mesh) {
    if (mesh.triangles.empty()) return mesh;
    const auto centre = [&](const Triangle& t) {
        return Vec3((mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3);
    };
    Vec3 low = centre(mesh.triangles[0]), high = low;
    for (const Triangle& t : mesh.triangles) {
        low = low.cwiseMin(centre(t));
        high = high.cwiseMax(centre(t));
    }
    const double extent = (high - low).maxCoeff();
    const double scale = extent > 0 ? ((1 << kBits) - 1) / extent : 0;
    std::vector<std::pair<uint64_t, Triangle>> coded;
    coded.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) coded.emplace_back(morton_code(scale * (centre(t) - low)), t);
    std::stable_sort(coded.begin(), coded.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (size_t f = 0; f < coded.size(); ++f) mesh.triangles[f] = coded[f].second;
    return mesh;
}

}  // namespace gim
