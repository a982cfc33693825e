#include "encoder/image/geometry_image.h"

namespace gim {

Surface surface_of(const GeometryImage& image) {
    const std::vector<uint32_t>& point = image.gluing.representative;
    Surface surface;
    std::vector<uint32_t> vertex(point.size(), kNone);
    const auto vertex_of = [&](uint32_t sample) {
        uint32_t& v = vertex[point[sample]];
        if (v == kNone) {
            v = static_cast<uint32_t>(surface.sample.size());
            surface.sample.push_back(point[sample]);
            surface.mesh.positions.push_back(image.positions[point[sample]]);
        }
        return v;
    };
    for (const auto& [a, b, c] : triangulate_grid(image.positions, image.gluing).triangles)
        surface.mesh.triangles.push_back({vertex_of(a), vertex_of(b), vertex_of(c)});
    return surface;
}

Mesh samples_as_mesh(const GeometryImage& image) {
    return {image.positions, triangulate_grid(image.positions, image.gluing).triangles};
}

}  // namespace gim
