#include "encoder/surface/sharp_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "corpus/generators.h"
#include "encoder/surface/clean.h"
#include "tests/models.h"

namespace gim {
namespace {

Mesh cleaned(const TriangleMesh& mesh) { return clean(mesh, {.require_connected = false}).value().mesh; }

double bend(const Mesh& mesh, const Topology& topology, uint32_t h) {
    const auto normal = [&](uint32_t f) {
        const Triangle& t = mesh.triangles[f];
        return (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
    };
    const Vec3 a = normal(face_of(h)), b = normal(face_of(topology.twin[h]));
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

// Number of sharp edges. Expects both half-edges of each to be marked.
size_t sharp_count(const Mesh& mesh) {
    const std::vector<bool> sharp = sharp_edges(mesh);
    const Topology topology = build_topology(mesh);
    size_t count = 0;
    for (uint32_t h = 0; h < sharp.size(); ++h) {
        if (!sharp[h]) continue;
        EXPECT_NE(topology.twin[h], kNone);
        if (topology.twin[h] != kNone) {
            EXPECT_TRUE(sharp[topology.twin[h]]);
        }
        ++count;
    }
    return count / 2;
}

// Expects those edges to be sharp whose faces meet at more than an angle, in degrees.
void expect_sharp_above(const Mesh& mesh, double angle, const std::string& name) {
    const std::vector<bool> sharp = sharp_edges(mesh);
    const Topology topology = build_topology(mesh);
    size_t count = 0;
    for (uint32_t h = 0; h < sharp.size(); ++h) {
        if (topology.twin[h] == kNone) continue;
        const bool expected = bend(mesh, topology, h) > angle;
        ASSERT_EQ(sharp[h], expected) << name << ", half-edge " << h;
        count += expected;
    }
    EXPECT_GT(count, 0u) << name;
}

// A cylinder with caps.
TriangleMesh prism(uint32_t sides, uint32_t rows) {
    TriangleMesh mesh;
    for (uint32_t r = 0; r <= rows; ++r) {
        for (uint32_t s = 0; s < sides; ++s) {
            const double angle = 2 * std::numbers::pi * s / sides;
            mesh.positions.push_back({std::cos(angle), std::sin(angle), 2.0 * r / rows - 1});
        }
    }
    const auto at = [&](uint32_t r, uint32_t s) { return r * sides + s % sides; };
    const auto bottom = static_cast<uint32_t>(mesh.positions.size()), top = bottom + 1;
    mesh.positions.push_back({0, 0, -1});
    mesh.positions.push_back({0, 0, 1});
    for (uint32_t s = 0; s < sides; ++s) {
        for (uint32_t r = 0; r < rows; ++r) {
            mesh.triangles.push_back({at(r, s), at(r, s + 1), at(r + 1, s + 1)});
            mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r + 1, s)});
        }
        mesh.triangles.push_back({bottom, at(0, s + 1), at(0, s)});
        mesh.triangles.push_back({top, at(rows, s), at(rows, s + 1)});
    }
    return mesh;
}

// A cube whose edges are round, `cells` cells of n wide on each face.
TriangleMesh rounded_box(uint32_t n, uint32_t cells) {
    TriangleMesh mesh = corpus::box(n, 1, 1);
    double most = 0;
    for (const auto& p : mesh.positions)
        for (const double x : p) most = std::max(most, std::abs(x));
    const double radius = 2 * most * cells / n, inner = most - radius;
    for (auto& p : mesh.positions) {
        const Vec3 at(p[0], p[1], p[2]);
        const Vec3 middle = at.cwiseMax(Vec3::Constant(-inner)).cwiseMin(Vec3::Constant(inner));
        const Vec3 round = middle + radius * (at - middle).normalized();
        p = {round[0], round[1], round[2]};
    }
    return mesh;
}

// A sheet with a fold along y whose angle falls from `from` degrees to `to`.
TriangleMesh folded_sheet(double from, double to) {
    TriangleMesh mesh = corpus::terrain(30);
    for (auto& p : mesh.positions) {
        const double angle = from + (to - from) * (p[1] + 1) / 2;
        p[2] = std::tan(angle * std::numbers::pi / 360) * std::abs(p[0]) + 0.1 * p[1] * p[1];
    }
    return mesh;
}

TEST(SharpEdges, MachinedPartsHaveTheirEdges) {
    for (const uint32_t n : {1u, 2u, 8u}) {
        const Mesh box = cleaned(corpus::box(n, 0.7, 0.4));
        expect_sharp_above(box, 45, "box " + std::to_string(n));
        EXPECT_EQ(sharp_count(box), 12 * n);
    }
    expect_sharp_above(cleaned(corpus::plate_with_holes(2, 3)), 45, "plate");
    expect_sharp_above(cleaned(prism(6, 1)), 45, "hexagon");
    expect_sharp_above(cleaned(prism(6, 5)), 45, "hexagon in rows");
    expect_sharp_above(cleaned(corpus::roughened(corpus::box(8, 1, 1), 0.002, 3)), 45, "rough box");
}

TEST(SharpEdges, RimsOfCylindersAreSharpAndTheirFacetsAreNot) {
    for (const uint32_t sides : {8u, 12u, 24u, 64u}) {
        for (const uint32_t rows : {1u, 4u})
            expect_sharp_above(cleaned(prism(sides, rows)), 60, std::to_string(sides) + " sides");
    }
}

TEST(SharpEdges, RoundSurfacesHaveNone) {
    EXPECT_EQ(sharp_count(cleaned(corpus::sphere(2))), 0u);
    EXPECT_EQ(sharp_count(cleaned(corpus::sphere(12))), 0u);
    EXPECT_EQ(sharp_count(cleaned(corpus::torus(12, 8, 0.7, 0.3))), 0u);
    EXPECT_EQ(sharp_count(cleaned(corpus::open_cylinder(4, 8, 1))), 0u);
    EXPECT_EQ(sharp_count(cleaned(corpus::limbed_blob(24))), 0u);
    for (const uint32_t cells : {1u, 2u, 3u, 6u})
        EXPECT_EQ(sharp_count(cleaned(rounded_box(24, cells))), 0u) << cells << " cells";
}

TEST(SharpEdges, NoiseHasNone) {
    for (const uint64_t seed : {1, 2, 3}) {
        for (const double amplitude : {0.01, 0.02, 0.03}) {
            const Mesh mesh = cleaned(corpus::roughened(corpus::sphere(24), amplitude, seed));
            EXPECT_EQ(sharp_count(mesh), 0u) << amplitude << " " << seed;
        }
    }
}

TEST(SharpEdges, FoldsGoOnWhereTheyGetFlatter) {
    const Mesh fading = cleaned(folded_sheet(60, 20));
    EXPECT_EQ(sharp_count(fading), 30u);
    EXPECT_EQ(sharp_count(cleaned(folded_sheet(30, 20))), 0u);  // nothing begins
    const size_t part = sharp_count(cleaned(folded_sheet(60, 0)));
    EXPECT_GT(part, 15u);
    EXPECT_LT(part, 28u);
}

TEST(SharpEdges, ModelsAreToldApart) {
    const std::string folder = GIM_MODELS_DIR;
    const auto part_of_edges = [&](const std::string& name) -> double {
        const auto model = read_model(folder + "/" + name + ".ply");
        if (!model) return -1;
        const Mesh mesh = cleaned(*model);
        return static_cast<double>(sharp_count(mesh)) / (1.5 * static_cast<double>(mesh.triangles.size()));
    };
    if (part_of_edges("fandisk") < 0) GTEST_SKIP() << "no models in " << folder;
    for (const char* part : {"fandisk", "block"}) EXPECT_GT(part_of_edges(part), 0.02) << part;
    for (const char* scan : {"horse", "bunny", "eight"}) EXPECT_LT(part_of_edges(scan), 0.001) << scan;
}

}  // namespace
}  // namespace gim
