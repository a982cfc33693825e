#include "encoder/planes/plane_images.h"

#include <utility>

#include "encoder/code/code_bands.h"

namespace gim {

PlaneCoder coder_of(Pyramid<float> pyramid) {
    return [pyramid = std::move(pyramid)](float quantizer) {
        Pyramid<int32_t> bands = quantize_bands(pyramid, {quantizer}).bands;
        return std::move(code_bands(bands, 1, CoefficientKind::kPlanes)[0]);
    };
}

std::vector<Vec3> outside_directions(const GeometryImage& image) {
    const std::vector<uint32_t>& point = image.gluing.representative;
    std::vector<Vec3> sum(image.positions.size(), Vec3::Zero()), outside(sum.size(), Vec3::Zero());
    for (const Triangle& t : triangulate_grid(image.positions, image.gluing).triangles) {
        const Vec3& a = image.positions[t[0]];
        const Vec3 n = (image.positions[t[1]] - a).cross(image.positions[t[2]] - a);
        for (const uint32_t v : t) sum[point[v]] += n;
    }
    for (size_t v = 0; v < outside.size(); ++v) {
        if (point[v] != kNone) outside[v] = unit_or_zero(sum[point[v]]);
    }
    return outside;
}

}  // namespace gim
