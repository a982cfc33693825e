#include "encoder/image/snapshot.h"

#include <algorithm>
#include <utility>

#include "encoder/image/gluing.h"
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

Snapshot make_snapshot(std::string name, std::string caption, const Atlas& atlas, const Packing& packing) {
    Snapshot state{std::move(name), std::move(caption), {}, {}, {}};
    const double longer = std::max(packing.width, packing.height) - 1;
    Mesh opened;
    for (size_t c = 0; c < atlas.charts.size(); ++c) {
        const Chart& chart = atlas.charts[c];
        const auto first = static_cast<uint32_t>(opened.positions.size());
        for (size_t v = 0; v < chart.mesh.positions.size(); ++v) {
            opened.positions.push_back(chart.mesh.positions[v]);
            const Vec2 p = packing.charts[c].chart.pose(atlas.maps[c].uv[v]) / longer;
            state.uv.push_back({p.x(), p.y()});
        }
        for (const Triangle& t : chart.mesh.triangles)
            opened.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        for (size_t i = 0; i < chart.loop.size(); ++i)
            state.cut.push_back({first + chart.loop[i], first + chart.loop[(i + 1) % chart.loop.size()]});
    }
    state.mesh = to_triangle_mesh(opened.positions, std::move(opened.triangles));
    return state;
}

Snapshot make_snapshot(std::string name, std::string caption, const MultiChartImage& image) {
    Snapshot state{std::move(name), std::move(caption), {}, {}, {}};
    const double longer = std::max(image.width(), image.height()) - 1;
    const std::vector<std::vector<uint32_t>> loops = trace_borders(image.mask);
    std::vector<Triangle> triangles;
    if (const auto point = glue_samples(image.mask, image.seams); point.ok()) {
        for (const CellTriangle& t : triangles_of(image, point.value())) triangles.push_back(t.corners);
    }
    state.mesh = to_triangle_mesh(image.positions, std::move(triangles));
    for (const auto& loop : loops) {
        for (size_t i = 0; i < loop.size(); ++i) state.cut.push_back({loop[i], loop[(i + 1) % loop.size()]});
    }
    for (uint32_t i = 0; i < image.positions.size(); ++i)
        state.uv.push_back({(i % image.width()) / longer, (i / image.width()) / longer});
    return state;
}

}  // namespace gim
