#include "encoder/tiles/start_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "encoder/surface/stretch.h"
#include "encoder/surface/tutte.h"

namespace gim {

namespace {

// Per half-edge of the triangles: the side of a tile that runs along it, or kNone.
std::vector<uint32_t> sides_of(const std::vector<Triangle>& triangles, const std::vector<Quad>& quads) {
    std::map<std::array<uint32_t, 2>, uint32_t> sides;
    for (uint32_t h = 0; h < 4 * quads.size(); ++h) sides[{quads[h / 4][h % 4], quads[h / 4][(h + 1) % 4]}] = h;
    std::vector<uint32_t> result(3 * triangles.size(), kNone);
    for (uint32_t h = 0; h < result.size(); ++h) {
        const auto found = sides.find({triangles[h / 3][h % 3], triangles[h / 3][(h % 3 + 1) % 3]});
        if (found != sides.end()) result[h] = found->second;
    }
    return result;
}

// Per triangle: its tile, or kNone.
std::vector<uint32_t> tiles_of(const Topology& topology, const std::vector<uint32_t>& sides) {
    std::vector<uint32_t> tile(sides.size() / 3, kNone), stack;
    for (uint32_t h = 0; h < sides.size(); ++h) {
        if (sides[h] == kNone || tile[face_of(h)] != kNone) continue;
        tile[face_of(h)] = sides[h] / 4;
        stack.push_back(face_of(h));
        while (!stack.empty()) {
            const uint32_t f = stack.back();
            stack.pop_back();
            for (uint32_t inner = 3 * f; inner < 3 * f + 3; ++inner) {
                if (sides[inner] != kNone || topology.twin[inner] == kNone) continue;
                const uint32_t beyond = face_of(topology.twin[inner]);
                if (tile[beyond] != kNone) continue;
                tile[beyond] = tile[f];
                stack.push_back(beyond);
            }
        }
    }
    return tile;
}

// Lays out the triangles of one tile. Returns false if one of them is not counter-clockwise.
bool lay_out(const std::vector<Triangle>& triangles, const std::vector<uint32_t>& members, const Quad& quad,
             std::vector<FlatFace>& faces) {
    std::vector<uint32_t> vertices(quad.begin(), quad.end());
    std::vector<Triangle> local;
    for (const uint32_t f : members) {
        Triangle corners{};
        for (size_t i = 0; i < 3; ++i) {
            const auto known = std::find(vertices.begin(), vertices.end(), triangles[f][i]);
            corners[i] = static_cast<uint32_t>(known - vertices.begin());
            if (known == vertices.end()) vertices.push_back(triangles[f][i]);
        }
        local.push_back(corners);
    }
    std::vector<Vec2> uv(vertices.size(), Vec2::Zero());
    std::vector<uint8_t> fixed(vertices.size(), 0);
    for (uint32_t i = 0; i < 4; ++i) uv[i] = TileWalker::corner(i), fixed[i] = 1;
    std::vector<std::array<uint32_t, 2>> arcs;
    for (const Triangle& t : local) {
        for (size_t i = 0; i < 3; ++i) arcs.push_back({t[i], t[(i + 1) % 3]});
    }
    if (!solve_tutte(arcs, fixed, uv)) return false;
    for (Vec2& p : uv) p = {std::round(p.x() / kGrid) * kGrid, std::round(p.y() / kGrid) * kGrid};
    for (size_t k = 0; k < local.size(); ++k) {
        const auto [a, b, c] = local[k];
        if (!(twice_signed_area(uv[a], uv[b], uv[c]) > 0)) return false;
        faces[members[k]].place = {uv[a], uv[b], uv[c]};
    }
    return true;
}

}  // namespace

Result<std::vector<FlatFace>> start_map(const std::vector<Triangle>& triangles, const std::vector<Quad>& quads,
                                        uint32_t vertex_count) {
    const Topology topology = build_topology({std::vector<Vec3>(vertex_count), triangles});
    const std::vector<uint32_t> tile = tiles_of(topology, sides_of(triangles, quads));
    std::vector<FlatFace> faces(triangles.size());
    std::vector<std::vector<uint32_t>> members(quads.size());
    for (uint32_t f = 0; f < triangles.size(); ++f) {
        if (tile[f] == kNone)
            return Error{Stage::kParametrize,
                         "base triangle " + std::to_string(f) + " belongs to no tile; this is an error of the program"};
        faces[f].tile = tile[f];
        members[tile[f]].push_back(f);
    }
    for (uint32_t q = 0; q < quads.size(); ++q) {
        if (!lay_out(triangles, members[q], quads[q], faces))
            return Error{Stage::kParametrize, "the base triangles of tile " + std::to_string(q) +
                                                  " do not fill it; this is an error of the program"};
    }
    return faces;
}

}  // namespace gim
