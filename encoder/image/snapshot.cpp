#include "encoder/image/snapshot.h"

#include <algorithm>
#include <utility>

namespace gim {

namespace {

// Returns the edges that only one triangle has. The triangle is on their left.
std::vector<std::array<uint32_t, 2>> open_edges(const std::vector<Triangle>& triangles) {
    std::vector<std::array<uint32_t, 2>> edges;
    for (const Triangle& t : triangles) {
        for (size_t k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
    }
    std::sort(edges.begin(), edges.end());
    std::vector<std::array<uint32_t, 2>> open;
    for (const auto& [a, b] : edges) {
        if (!std::binary_search(edges.begin(), edges.end(), std::array<uint32_t, 2>{b, a})) open.push_back({a, b});
    }
    return open;
}

}  // namespace

std::vector<std::array<uint32_t, 2>> edges_of_loop(const std::vector<uint32_t>& loop) {
    std::vector<std::array<uint32_t, 2>> edges;
    for (size_t i = 0; i < loop.size(); ++i) edges.push_back({loop[i], loop[(i + 1) % loop.size()]});
    return edges;
}

Snapshot make_snapshot(std::string name, std::string caption, const Mesh& opened,
                       std::vector<std::array<uint32_t, 2>> cut, const std::vector<Vec2>& uv) {
    Snapshot state{std::move(name), std::move(caption), {}, std::move(cut), {}};
    for (const Vec3& p : opened.positions) state.mesh.positions.push_back({p.x(), p.y(), p.z()});
    state.mesh.triangles = opened.triangles;
    for (const Vec2& p : uv) state.uv.push_back({p.x(), p.y()});
    return state;
}

Snapshot make_snapshot(std::string name, std::string caption, const GeometryImage& image) {
    const double longer = std::max(image.width(), image.height()) - 1;
    std::vector<Vec2> uv;
    for (uint32_t row = 0; row < image.height(); ++row) {
        for (uint32_t column = 0; column < image.width(); ++column) uv.push_back(Vec2(column, row) / longer);
    }
    const Mesh mesh = samples_as_mesh(image);
    return make_snapshot(std::move(name), std::move(caption), mesh, open_edges(mesh.triangles), uv);
}

}  // namespace gim
