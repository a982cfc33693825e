// Random surfaces that are no manifolds: voxels, bodies that touch, clustered vertices, fins, copies, turned and merged
// parts, random triangles, one-sided surfaces. Cleaning makes a manifold of each.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "corpus/generators.h"
#include "encoder/surface/clean.h"
#include "tests/encoder/volume.h"
#include "tests/random_numbers.h"

namespace gim {
namespace {

using corpus::Point;

uint32_t any_of(Random& random, size_t count) { return number_between(random, 0, static_cast<uint32_t>(count) - 1); }

bool has_three_corners(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

// Sends vertices to others, and leaves out what collapses.
TriangleMesh with_vertices_sent(const TriangleMesh& mesh, const std::vector<uint32_t>& to) {
    TriangleMesh result{mesh.positions, {}};
    for (const Triangle& t : mesh.triangles) {
        const Triangle sent = {to[t[0]], to[t[1]], to[t[2]]};
        if (has_three_corners(sent)) result.triangles.push_back(sent);
    }
    return result;
}

// One vertex for each point of the integer grid.
class Grid {
  public:
    uint32_t at(const std::array<int, 3>& p) {
        const auto [it, is_new] = number_.try_emplace(p, static_cast<uint32_t>(mesh.positions.size()));
        if (is_new) mesh.positions.push_back({double(p[0]), double(p[1]), double(p[2])});
        return it->second;
    }
    // Adds the side of a unit cube at p that faces to `sign` along an axis.
    void add_side(const std::array<int, 3>& p, size_t axis, int sign) {
        const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<uint32_t, 4> corners{};
        for (size_t k = 0; k < 4; ++k) {
            std::array<int, 3> q = p;
            q[axis] += sign > 0;
            q[u] += k == 1 || k == 2;
            q[v] += k >= 2;
            corners[k] = at(q);
        }
        if (sign < 0) std::swap(corners[1], corners[3]);
        mesh.triangles.push_back({corners[0], corners[1], corners[2]});
        mesh.triangles.push_back({corners[0], corners[2], corners[3]});
    }

    TriangleMesh mesh;

  private:
    std::map<std::array<int, 3>, uint32_t> number_;
};

struct Cubes {
    TriangleMesh mesh;
    uint64_t count = 0;
};

// Unit cubes on a grid. hollow: without the sides between two of them.
Cubes cubes(Random& random, bool hollow) {
    std::set<std::array<int, 3>> used;
    const uint32_t count = number_between(random, 2, hollow ? 60 : 12), side = number_between(random, 2, 5);
    for (uint32_t k = 0; k < count; ++k)
        used.insert({int(any_of(random, side)), int(any_of(random, side)), int(any_of(random, 3))});
    Grid grid;
    for (const std::array<int, 3>& p : used) {
        for (size_t axis = 0; axis < 3; ++axis) {
            for (const int sign : {-1, 1}) {
                std::array<int, 3> beside = p;
                beside[axis] += sign;
                if (!hollow || used.count(beside) == 0) grid.add_side(p, axis, sign);
            }
        }
    }
    return {std::move(grid.mesh), used.size()};
}

TriangleMesh sound(Random& random) {
    switch (any_of(random, 5)) {
        case 0:
            return corpus::sphere(number_between(random, 3, 10));
        case 1:
            return corpus::torus(number_between(random, 6, 24), number_between(random, 5, 12), 0.7, 0.25);
        case 2:
            return corpus::roughened(corpus::sphere(10), between(random, 0.05, 0.3), random());
        case 3:
            return corpus::melted_tori(number_between(random, 2, 5), number_between(random, 14, 22));
        default:
            return corpus::terrain(number_between(random, 6, 20));
    }
}

// All vertices of a cell of a grid become one, as in a crude simplification.
TriangleMesh clustered(Random& random) {
    const TriangleMesh mesh = sound(random);
    const double size = between(random, 0.1, 0.6);
    std::map<std::array<long, 3>, uint32_t> first;
    std::vector<uint32_t> to;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const Point& p = mesh.positions[v];
        const std::array<long, 3> cell = {std::lround(p[0] / size), std::lround(p[1] / size), std::lround(p[2] / size)};
        to.push_back(first.try_emplace(cell, v).first->second);
    }
    return with_vertices_sent(mesh, to);
}

TriangleMesh finned(Random& random) {
    TriangleMesh mesh = sound(random);
    for (uint32_t k = number_between(random, 1, 40); k > 0; --k) {
        const Triangle t = mesh.triangles[any_of(random, mesh.triangles.size())];
        const uint32_t i = any_of(random, 3);
        Point tip = mesh.positions[t[i]];
        const double out = between(random, 1.05, 1.5);
        for (double& x : tip) x *= out;
        mesh.positions.push_back(tip);
        const auto v = static_cast<uint32_t>(mesh.positions.size() - 1);
        const uint32_t a = t[i], b = t[(i + 1) % 3];
        mesh.triangles.push_back(random() % 2 == 0 ? Triangle{a, b, v} : Triangle{b, a, v});
    }
    return mesh;
}

TriangleMesh with_copies(Random& random) {
    TriangleMesh mesh = sound(random);
    for (uint32_t k = number_between(random, 1, 60); k > 0; --k) {
        Triangle t = mesh.triangles[any_of(random, mesh.triangles.size())];
        if (random() % 2 == 0) std::swap(t[0], t[1]);
        mesh.triangles.push_back(t);
    }
    return mesh;
}

TriangleMesh partly_turned(Random& random) {
    TriangleMesh mesh = sound(random);
    const double part = between(random, 0.02, 0.5);
    for (Triangle& t : mesh.triangles)
        if (between(random, 0, 1) < part) std::swap(t[0], t[1]);
    return mesh;
}

TriangleMesh merged(Random& random) {
    const TriangleMesh mesh = sound(random);
    std::vector<uint32_t> to;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) to.push_back(v);
    for (uint32_t k = number_between(random, 1, 30); k > 0; --k) {
        const uint32_t from = any_of(random, to.size()), into = to[any_of(random, to.size())];
        for (uint32_t& v : to)
            if (v == from) v = into;
    }
    return with_vertices_sent(mesh, to);
}

TriangleMesh chaos(Random& random) {
    TriangleMesh mesh;
    const uint32_t count = number_between(random, 4, 20);
    for (uint32_t v = 0; v < count; ++v)
        mesh.positions.push_back({between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)});
    mesh.triangles = {{0, 1, 2}};
    for (uint32_t k = number_between(random, 1, 4 * count); k > 0; --k) {
        const Triangle t = {any_of(random, count), any_of(random, count), any_of(random, count)};
        if (has_three_corners(t)) mesh.triangles.push_back(t);
    }
    return mesh;
}

// A band with a half turn, or a closed one: a Klein bottle with random corners.
TriangleMesh one_sided(Random& random) {
    const uint32_t length = number_between(random, 6, 40), width = number_between(random, 1, 12);
    const bool is_closed = width > 4 && random() % 2 == 0;
    const uint32_t across = is_closed ? width : width + 1;
    TriangleMesh mesh;
    for (uint32_t k = 0; k < length * across; ++k)
        mesh.positions.push_back({between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)});
    const auto at = [&](uint32_t i, uint32_t k) {
        return i < length ? i * across + k % across : (i - length) * across + (width - k % across) % across;
    };
    for (uint32_t i = 0; i < length; ++i) {
        for (uint32_t k = 0; k < width; ++k) {
            mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    }
    return mesh;
}

CleanMesh cleaned(const TriangleMesh& mesh) {
    const auto result = clean(mesh, {.require_connected = false});
    if (!result.ok()) {
        ADD_FAILURE() << result.error().message;
        return {};
    }
    const Mesh& made = result.value().mesh;
    EXPECT_TRUE(result.value().report.topology.manifold);
    EXPECT_EQ(result.value().source_vertex.size(), made.positions.size());
    for (const uint32_t twin : build_topology(made).twin)
        EXPECT_TRUE(twin == kNone || twin < 3 * made.triangles.size());
    return result.value();
}

TEST(BrokenSurfaces, BecomeManifolds) {
    const std::pair<const char*, TriangleMesh (*)(Random&)> kinds[] = {
        {"clustered", clustered}, {"finned", finned}, {"copies", with_copies},  {"turned", partly_turned},
        {"merged", merged},       {"chaos", chaos},   {"one-sided", one_sided},
    };
    for (const auto& [name, make] : kinds) {
        for (uint64_t seed = 0; seed < 40; ++seed) {
            SCOPED_TRACE(name + std::string(", seed ") + std::to_string(seed));
            Random random(seed);
            const TriangleMesh mesh = make(random);
            if (!mesh.triangles.empty()) cleaned(mesh);
        }
    }
}

// The file's way of sharing vertices does not matter.
TEST(BrokenSurfaces, AreRepairedAlikeAsTrianglesWithoutSharedVertices) {
    for (uint64_t seed = 0; seed < 40; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const TriangleMesh mesh = cubes(random, seed % 2 == 0).mesh;
        const CleanMesh shared = cleaned(mesh), soup = cleaned(corpus::soup(mesh));
        EXPECT_EQ(shared.report.topology.components, soup.report.topology.components);
        EXPECT_EQ(shared.report.topology.genus, soup.report.topology.genus);
        EXPECT_EQ(shared.report.repairs.crowded_edges, soup.report.repairs.crowded_edges);
        EXPECT_EQ(shared.report.repairs.split_points, soup.report.repairs.split_points);
    }
}

TEST(BrokenSurfaces, BodiesThatTouchStayBodies) {
    for (uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Cubes bodies = cubes(random, false);
        const CleanMesh made = cleaned(bodies.mesh);
        EXPECT_EQ(made.report.topology.components, bodies.count);
        EXPECT_EQ(made.report.topology.boundary_loops, 0u);
        EXPECT_NEAR(volume_of(made.mesh), static_cast<double>(bodies.count), 1e-9);
    }
}

TEST(BrokenSurfaces, VoxelsKeepTheirVolume) {
    for (uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Cubes voxels = cubes(random, true);
        const CleanMesh made = cleaned(voxels.mesh);
        EXPECT_EQ(made.report.topology.boundary_loops, 0u);
        EXPECT_NEAR(volume_of(made.mesh), static_cast<double>(voxels.count), 1e-9);
    }
}

}  // namespace
}  // namespace gim
