#include <array>

#include "encoder/surface/topology_summary.h"
#include "encoder/tiles/tile_base.h"

namespace gim {

namespace {

// A component with fewer faces leaves too little choice.
constexpr uint32_t kFewFaces = 48;

// Splits each face of small components into four.
TileInput split_small_components(const TileInput& input) {
    const Mesh& mesh = input.mesh;
    const Topology topology = build_topology(mesh);
    const Components components = connected_components(mesh.triangles, mesh.positions.size());
    std::vector<uint32_t> faces(components.count, 0);
    for (const uint32_t c : components.of_face) ++faces[c];

    TileInput result{{mesh.positions, {}}, {}};
    std::vector<uint32_t> middles(topology.twin.size(), kNone);
    const auto middle = [&](uint32_t h) {
        const uint32_t t = topology.twin[h];
        if (middles[h] == kNone && t != kNone) middles[h] = middles[t];
        if (middles[h] == kNone) {
            middles[h] = static_cast<uint32_t>(result.mesh.positions.size());
            result.mesh.positions.push_back(0.5 * (mesh.positions[from(mesh, h)] + mesh.positions[to(mesh, h)]));
        }
        return middles[h];
    };
    const auto add = [&](const Triangle& triangle, const std::array<bool, 3>& sharp) {
        result.mesh.triangles.push_back(triangle);
        result.sharp.insert(result.sharp.end(), sharp.begin(), sharp.end());
    };
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        std::array<bool, 3> sharp{};
        for (uint32_t i = 0; i < 3 && !input.sharp.empty(); ++i) sharp[i] = input.sharp[3 * f + i];
        if (faces[components.of_face[f]] >= kFewFaces) {
            add(t, sharp);
            continue;
        }
        const Triangle m{middle(3 * f), middle(3 * f + 1), middle(3 * f + 2)};
        for (uint32_t i = 0; i < 3; ++i) add({t[i], m[i], m[(i + 2) % 3]}, {sharp[i], false, sharp[(i + 2) % 3]});
        add(m, {false, false, false});
    }
    return result;
}

// Splits an edge of each boundary that has three. Boundaries of four edges or more can always be made even.
void split_short_boundaries(TileInput& input) {
    Mesh& mesh = input.mesh;
    const Topology topology = build_topology(mesh);
    // Half-edge h of a boundary is followed by the one that leaves to(h) and has no twin.
    const auto following = [&](uint32_t h) { return topology.outgoing[to(mesh, h)]; };
    std::vector<uint32_t> splits;
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (topology.twin[h] != kNone) continue;
        const uint32_t second = following(h), third = following(second);
        if (following(third) == h && h < second && h < third) splits.push_back(h);
    }
    for (const uint32_t h : splits) {
        const uint32_t f = face_of(h), i = h % 3, a = from(mesh, h), b = to(mesh, h), c = from(mesh, prev(h));
        const auto middle = static_cast<uint32_t>(mesh.positions.size());
        mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
        mesh.triangles.push_back({middle, b, c});
        mesh.triangles[f][(i + 1) % 3] = middle;
        if (input.sharp.empty()) continue;
        input.sharp.insert(input.sharp.end(), {false, input.sharp[next(h)], false});
        input.sharp[next(h)] = false;
    }
}

bool has_small_component(const Mesh& mesh) {
    const Components components = connected_components(mesh.triangles, mesh.positions.size());
    std::vector<uint32_t> faces(components.count, 0);
    for (const uint32_t c : components.of_face) ++faces[c];
    for (const uint32_t count : faces) {
        if (count < kFewFaces) return true;
    }
    return false;
}

}  // namespace

TileInput make_room_for_tiles(Mesh mesh, std::vector<bool> sharp) {
    TileInput input{std::move(mesh), std::move(sharp)};
    while (has_small_component(input.mesh)) input = split_small_components(input);
    split_short_boundaries(input);
    return input;
}

}  // namespace gim
