// The topology of what comes out of a file.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "encoder/code/decode_surface.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

inline TriangleMesh as_input(const Mesh& mesh) {
    TriangleMesh result;
    for (const Vec3& p : mesh.positions) result.positions.push_back({p.x(), p.y(), p.z()});
    result.triangles = mesh.triangles;
    return result;
}

// The decoded surface of the level has the input's topology.
inline void expect_topology(const Encoded& encoded, uint32_t level, const std::string& name) {
    const auto decoded = decode_surface(encoded.bytes, level);
    ASSERT_TRUE(decoded.ok()) << name << " level " << level;
    const TopologySummary topology = summarize_topology(as_input(decoded.value()));
    const TopologySummary& expected = encoded.report.topology;
    EXPECT_TRUE(topology.manifold) << name << " level " << level;
    EXPECT_EQ(topology.components, expected.components) << name << " level " << level;
    EXPECT_EQ(topology.boundary_loops, expected.boundary_loops) << name << " level " << level;
    EXPECT_EQ(topology.genus, expected.genus) << name << " level " << level;
}

}  // namespace gim
