#include "encoder/planes/input_triangles.h"

namespace gim {

Mesh triangles_with_area(const TriangleMesh& mesh, std::vector<uint32_t>* source) {
    Mesh out;
    out.positions.reserve(mesh.positions.size());
    for (const auto& p : mesh.positions) out.positions.emplace_back(p[0], p[1], p[2]);
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        const auto& t = mesh.triangles[f];
        const Vec3 &a = out.positions[t[0]], &b = out.positions[t[1]], &c = out.positions[t[2]];
        if (!((b - a).cross(c - a).squaredNorm() > 0)) continue;
        out.triangles.push_back(t);
        source->push_back(f);
    }
    return out;
}

}  // namespace gim
