#include "encoder/snapshot.h"

#include <utility>

#include "encoder/grid_surface.h"
#include "format/ring.h"

namespace gim {

namespace {

TriangleMesh to_triangle_mesh(const std::vector<Vec3>& positions, std::vector<Triangle> triangles) {
    TriangleMesh mesh;
    mesh.positions.reserve(positions.size());
    for (const Vec3& p : positions) mesh.positions.push_back({p.x(), p.y(), p.z()});
    mesh.triangles = std::move(triangles);
    return mesh;
}

}  // namespace

Snapshot make_snapshot(std::string name, std::string caption, const OpenedMesh& opened, const std::vector<Vec2>& uv) {
    Snapshot state{std::move(name), std::move(caption), {}, {}, {}};
    state.mesh = to_triangle_mesh(opened.mesh.positions, opened.mesh.triangles);
    for (size_t i = 0; i < opened.loop.size(); ++i)
        state.cut.push_back({opened.loop[i], opened.loop[(i + 1) % opened.loop.size()]});
    for (const Vec2& p : uv) state.uv.push_back({p.x(), p.y()});
    return state;
}

Snapshot make_snapshot(std::string name, std::string caption, const GeometryImage& image) {
    Snapshot state{std::move(name), std::move(caption), {}, {}, {}};
    const uint32_t side = image.side, ring = ring_length(side);
    if (const auto gluing = glue_ring(image.sideband, side); gluing.ok())
        state.mesh = to_triangle_mesh(image.positions, triangulate_grid(image.positions, gluing.value()).triangles);
    const auto sample = [&](uint32_t k) {
        const GridPoint p = ring_point(side, k % ring);
        return p.row * side + p.column;
    };
    for (uint32_t k = 0; k < ring; ++k) state.cut.push_back({sample(k), sample(k + 1)});
    for (uint32_t row = 0; row < side; ++row) {
        for (uint32_t column = 0; column < side; ++column)
            state.uv.push_back({double(column) / (side - 1), double(row) / (side - 1)});
    }
    return state;
}

}  // namespace gim
