// The encoder's working mesh: an indexed oriented 2-manifold, possibly with boundaries, and its half-edge topology.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace gim {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Triangle = std::array<uint32_t, 3>;

inline constexpr uint32_t kNone = UINT32_MAX;

struct Mesh {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;  // counter-clockwise seen from outside
};

// Half-edge 3*f+i runs from corner i to corner i+1 of face f.
inline uint32_t face_of(uint32_t h) { return h / 3; }
inline uint32_t next(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline uint32_t prev(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
inline uint32_t from(const Mesh& m, uint32_t h) { return m.triangles[h / 3][h % 3]; }
inline uint32_t to(const Mesh& m, uint32_t h) { return m.triangles[h / 3][(h % 3 + 1) % 3]; }

struct Topology {
    std::vector<uint32_t> twin;      // per half-edge: the opposite one; kNone on a boundary
    std::vector<uint32_t> outgoing;  // per vertex: a half-edge that leaves it; kNone if isolated. On a boundary vertex
                                     // no other one precedes it clockwise: walking h = twin(prev(h)) until kNone meets
                                     // every face of the vertex.
};

// In: an oriented 2-manifold (see clean.h). O(F log F).
Topology build_topology(const Mesh& mesh);

inline double face_area(const Mesh& m, uint32_t f) {
    const Triangle& t = m.triangles[f];
    return 0.5 * (m.positions[t[1]] - m.positions[t[0]]).cross(m.positions[t[2]] - m.positions[t[0]]).norm();
}

}  // namespace gim
