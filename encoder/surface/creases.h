// Measures how much of a surface is crease: much on machined parts, hardly any on scans.
#pragma once

#include <Eigen/Geometry>

#include "encoder/surface/mesh.h"
#include "encoder/surface/topology_summary.h"

namespace gim {

// Returns the total length of edges sharper than 60 degrees. O(F).
inline double crease_length(const Mesh& mesh) {
    const EdgeTable edges = build_edge_table(mesh.triangles, mesh.positions.size());
    const auto normal = [&](uint32_t halfedge) {
        const Triangle& t = mesh.triangles[halfedge / 3];
        const Vec3& a = mesh.positions[t[0]];
        return Vec3((mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).normalized());
    };
    double length = 0;
    for (size_t e = 0; e < edges.size(); ++e) {
        const auto around = edges.around(e);
        if (around.size() != 2 || normal(around[0]).dot(normal(around[1])) > 0.5) continue;
        length += (mesh.positions[to(mesh, around[0])] - mesh.positions[from(mesh, around[0])]).norm();
    }
    return length;
}

}  // namespace gim
