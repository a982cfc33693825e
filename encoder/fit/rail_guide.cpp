#include "encoder/fit/rail_guide.h"

#include <algorithm>

#include "encoder/fit/image_surface.h"

namespace gim {

RailGuide::RailGuide(const Rails& rails) : curve_of_(rails.of_sample) {
    for (const std::vector<Vec3>& curve : rails.curves) {
        Mesh mesh{curve, {}};
        const auto count = static_cast<uint32_t>(curve.size());
        for (uint32_t i = 0; i < std::max(count - 1, 1u); ++i) {
            const uint32_t end = std::min(i + 1, count - 1);
            mesh.triangles.push_back({i, end, end});
        }
        trees_.emplace_back(mesh, 1);
        curves_.push_back(std::move(mesh));
    }
}

Vec3 RailGuide::direction(uint32_t sample, const Vec3& place) const {
    const Mesh& curve = curves_[curve_of_[sample]];
    const Triangle& edge = curve.triangles[found(sample, place).triangle];
    return direction_or(curve.positions[edge[1]] - curve.positions[edge[0]], Vec3::Zero());
}

}  // namespace gim
