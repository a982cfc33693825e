#include "encoder/surface/authored_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "corpus/generators.h"
#include "encoder/surface/clean.h"
#include "encoder/surface/sharp_edges.h"
#include "tests/shaded_part.h"

namespace gim {
namespace {

using test::shade_flat;
using test::ShadedPart;

struct Authored {
    Mesh mesh;
    AuthoredEdges edges;
};

Authored authored(const TriangleMesh& input, const CleanOptions& options = {.require_connected = false}) {
    auto cleaned = clean(input, options);
    EXPECT_TRUE(cleaned.ok()) << cleaned.error().message;
    return {cleaned.value().mesh, read_authored_edges(cleaned.value().mesh, cleaned.value().breaks)};
}

size_t sharp_count(const std::vector<bool>& sharp) {
    return static_cast<size_t>(std::count(sharp.begin(), sharp.end(), true)) / 2;
}

// Expects the part's hard edges, all of them, and no others.
void expect_part(const TriangleMesh& input, const std::string& what) {
    const auto [mesh, edges] = authored(input);
    EXPECT_EQ(edges.named, ShadedPart::kHardEdges) << what;
    EXPECT_EQ(edges.kept, ShadedPart::kHardEdges) << what;
    EXPECT_EQ(sharp_count(creases_of(mesh, edges)), ShadedPart::kHardEdges) << what;
}

// Expects that the normals tell nothing.
void expect_nothing(const TriangleMesh& input, const std::string& what) {
    const auto [mesh, edges] = authored(input);
    EXPECT_TRUE(edges.words.empty()) << what;
    EXPECT_EQ(edges.named, 0u) << what;
    EXPECT_EQ(creases_of(mesh, edges), sharp_edges(mesh)) << what;
}

// Shades a mesh smoothly, but with creases where its faces meet at more than `degrees`: what programs call auto smooth.
void shade_above(TriangleMesh& mesh, double degrees) {
    shade_flat(mesh);
    const std::vector<std::array<float, 3>> faces = mesh.shading.normals;
    std::vector<std::vector<uint32_t>> around(mesh.positions.size());
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        for (const uint32_t v : mesh.triangles[f]) around[v].push_back(f);
    }
    const auto angle = [&](uint32_t f, uint32_t g) {
        double dot = 0, ff = 0, gg = 0;
        for (size_t k = 0; k < 3; ++k) {
            dot += double{faces[f][k]} * double{faces[g][k]};
            ff += double{faces[f][k]} * double{faces[f][k]};
            gg += double{faces[g][k]} * double{faces[g][k]};
        }
        return std::acos(std::clamp(dot / std::sqrt(ff * gg), -1.0, 1.0)) * 180 / std::numbers::pi;
    };
    const auto is_neighbour = [&](uint32_t f, uint32_t g) {
        const auto& s = mesh.triangles[f];
        const auto& t = mesh.triangles[g];
        return std::count_if(s.begin(), s.end(), [&](uint32_t v) { return std::count(t.begin(), t.end(), v) > 0; }) ==
               2;
    };
    mesh.shading = {};
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        std::array<uint32_t, 3> corners = {};
        for (size_t i = 0; i < 3; ++i) {
            // Faces that a way over smooth edges reaches.
            const std::vector<uint32_t>& fan = around[mesh.triangles[f][i]];
            std::vector<uint32_t> group = {f};
            for (size_t k = 0; k < group.size(); ++k) {
                for (const uint32_t g : fan) {
                    if (std::count(group.begin(), group.end(), g) == 0 && is_neighbour(group[k], g) &&
                        angle(group[k], g) <= degrees)
                        group.push_back(g);
                }
            }
            std::sort(group.begin(), group.end());
            std::array<float, 3> sum = {};
            for (const uint32_t g : group) {
                for (size_t k = 0; k < 3; ++k) sum[k] += faces[g][k];
            }
            corners[i] = static_cast<uint32_t>(mesh.shading.normals.size());
            mesh.shading.normals.push_back(sum);
        }
        mesh.shading.corners.push_back(corners);
    }
}

TEST(AuthoredEdges, AreThoseWhereNormalsBreak) {
    const ShadedPart part;
    expect_part(part.mesh, "shared vertices");
    expect_part(part.split(), "split vertices");
    TriangleMesh shape = part.mesh;
    shape.shading = {};
    expect_nothing(shape, "no normals");
    EXPECT_LT(sharp_count(sharp_edges(authored(shape).mesh)), ShadedPart::kHardEdges);
}

TEST(AuthoredEdges, OutliveCleaning) {
    TriangleMesh part = ShadedPart().split();
    std::swap(part.triangles[3][0], part.triangles[3][1]);
    std::swap(part.shading.corners[3][0], part.shading.corners[3][1]);
    expect_part(part, "a face turned over");

    part.triangles.push_back(part.triangles[0]);
    part.shading.corners.push_back(part.shading.corners[5]);
    expect_part(part, "a face twice");

    part.triangles.push_back({7, 7, 8});
    part.shading.corners.push_back({1, 2, 3});
    part.positions.insert(part.positions.begin(), {9, 9, 9});
    for (auto& t : part.triangles) {
        for (uint32_t& v : t) ++v;
    }
    expect_part(part, "a collapsed face and a vertex without a face");
}

TEST(AuthoredEdges, OutliveCopiesThatDoNotQuiteMeet) {
    TriangleMesh part = ShadedPart().split();
    // Copies on the caps move apart by less than the weld tolerance.
    for (size_t v = 0; v < part.positions.size(); ++v) {
        if (std::abs(part.shading.normals[v][2]) > 0.5F) part.positions[v][0] += 1.5e-6;
    }
    const auto found = clean(part);
    ASSERT_TRUE(found.ok()) << found.error().message;
    EXPECT_TRUE(found.value().report.topology.watertight);
    EXPECT_GT(found.value().report.repairs.nearly_welded, 0u);
    expect_part(part, "copies apart");
}

TEST(AuthoredEdges, FlatAndSmoothShadingTellNothing) {
    TriangleMesh part = ShadedPart().mesh;
    shade_above(part, 180);
    expect_nothing(part, "smooth");
    for (TriangleMesh mesh : {corpus::roughened(corpus::sphere(12), 0.01, 1), corpus::torus(24, 12, 1, 0.4)}) {
        shade_flat(mesh);
        expect_nothing(mesh, "flat");
        shade_above(mesh, 180);
        expect_nothing(mesh, "smooth");
    }
}

TEST(AuthoredEdges, NoiseTellsNothing) {
    for (const double amplitude : {0.02, 0.04, 0.08}) {
        TriangleMesh mesh = corpus::roughened(corpus::sphere(24), amplitude, 3);
        for (const double degrees : {20.0, 30.0, 60.0}) {
            shade_above(mesh, degrees);
            const auto [cleaned, edges] = authored(mesh);
            EXPECT_EQ(edges.kept, 0u) << amplitude << ", " << degrees;
        }
    }
}

TEST(AuthoredEdges, AutoSmoothOfAPartKeepsItsCreases) {
    TriangleMesh part = ShadedPart().mesh;
    shade_above(part, 20);
    expect_part(part, "auto smooth");
}

TEST(AuthoredEdges, LinesThatDoNotBendTheSurfaceAreLeftOut) {
    // The normals of the bottom cap differ left and right, as those of two materials may.
    TriangleMesh part = ShadedPart().mesh;
    for (size_t f = 0; f < part.triangles.size(); ++f) {
        for (size_t i = 0; i < 3; ++i) {
            auto& n = part.shading.normals[part.shading.corners[f][i]];
            const auto& t = part.triangles[f];
            double x = 0;
            for (const uint32_t v : t) x += part.positions[v][0] / 3;
            if (n[2] < -0.5F) n = {x < 0 ? -0.3F : 0.3F, 0, -1};
        }
    }
    const auto [mesh, edges] = authored(part);
    EXPECT_EQ(edges.named, ShadedPart::kHardEdges + 2);  // from the arc over the middle to the straight sides
    EXPECT_EQ(edges.kept, ShadedPart::kHardEdges);
}

TEST(AuthoredEdges, ConesAreSmoothAroundTheirApex) {
    const uint32_t sides = 16;
    TriangleMesh cone;
    cone.positions = {{0, 0, 1}, {0, 0, -1}};
    for (uint32_t s = 0; s < sides; ++s) {
        const double angle = 2 * std::numbers::pi * s / sides;
        cone.positions.push_back({std::cos(angle), std::sin(angle), -1});
    }
    const auto slope = [&](double s) {
        const double angle = 2 * std::numbers::pi * s / sides;
        return std::array<float, 3>{static_cast<float>(2 * std::cos(angle)), static_cast<float>(2 * std::sin(angle)),
                                    1};
    };
    for (uint32_t s = 0; s < sides; ++s) {
        const uint32_t a = 2 + s, b = 2 + (s + 1) % sides;
        const auto first = static_cast<uint32_t>(cone.shading.normals.size());
        cone.triangles.push_back({0, a, b});
        cone.triangles.push_back({1, b, a});
        for (const auto& n : {slope(s + 0.5), slope(s), slope(s + 1), std::array<float, 3>{0, 0, -1}})
            cone.shading.normals.push_back(n);
        cone.shading.corners.push_back({first, first + 1, first + 2});
        cone.shading.corners.push_back({first + 3, first + 3, first + 3});
    }
    const auto [mesh, edges] = authored(cone);
    EXPECT_EQ(edges.named, sides);
    EXPECT_EQ(edges.kept, sides);
}

TEST(AuthoredEdges, EachComponentSpeaksForItself) {
    // A part; a box without normals, whose edges the shape shows; and a box that its author wants round.
    TriangleMesh all = ShadedPart().mesh;
    const auto add = [&](const TriangleMesh& mesh, double x, bool is_round) {
        const auto first = static_cast<uint32_t>(all.positions.size());
        const auto normal = static_cast<uint32_t>(all.shading.normals.size());
        for (auto p : mesh.positions) {
            all.shading.normals.push_back(
                {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
            p[0] += x;
            all.positions.push_back(p);
        }
        for (const auto& t : mesh.triangles) {
            all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
            if (is_round) {
                all.shading.corners.push_back({normal + t[0], normal + t[1], normal + t[2]});
            } else {
                all.shading.corners.push_back({Shading::kFlat, Shading::kFlat, Shading::kFlat});
            }
        }
    };
    const uint32_t n = 4;
    add(corpus::box(n, 1, 1), 5, false);
    add(corpus::box(n, 1, 1), 10, true);
    const auto [mesh, edges] = authored(all);
    EXPECT_EQ(edges.kept, ShadedPart::kHardEdges);
    EXPECT_EQ(sharp_count(creases_of(mesh, edges)), ShadedPart::kHardEdges + 12 * n);
}

TEST(AuthoredEdges, NormalsThatAreNoneBreakNothing) {
    TriangleMesh part = ShadedPart().mesh;
    const float nan = std::nanf("");
    for (auto& n : part.shading.normals) n = {0, 0, 0};
    expect_nothing(part, "zero");
    for (auto& n : part.shading.normals) n = {nan, 1, 0};
    expect_nothing(part, "not a number");
    for (auto& n : part.shading.normals) n = {1e38F, 1e38F, 1e38F};
    expect_nothing(part, "huge");
}

TEST(AuthoredEdges, NormalsMustFitTheMesh) {
    TriangleMesh part = ShadedPart().mesh;
    part.shading.corners.pop_back();
    EXPECT_FALSE(clean(part).ok());
    part = ShadedPart().mesh;
    part.shading.corners[4][1] = static_cast<uint32_t>(part.shading.normals.size());
    EXPECT_FALSE(clean(part).ok());
}

}  // namespace
}  // namespace gim
