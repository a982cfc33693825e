// Surfaces that are no manifolds become manifolds, whatever form the file has.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "corpus/corpus.h"
#include "corpus/generators.h"
#include "encoder/surface/clean.h"
#include "tests/encoder/volume.h"
#include "tests/models.h"

namespace gim {
namespace {

using corpus::box;
using corpus::soup;

const CleanOptions kAny = {.require_connected = false};

TriangleMesh moved(TriangleMesh mesh, double x, double y, double z) {
    for (auto& p : mesh.positions) p = {p[0] + x, p[1] + y, p[2] + z};
    return mesh;
}

TriangleMesh turned(TriangleMesh mesh) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, double s) {
    for (auto& p : mesh.positions) p = {s * p[0], s * p[1], s * p[2]};
    return mesh;
}

// One vertex for each position: touching parts share vertices.
TriangleMesh indexed(const TriangleMesh& mesh) {
    TriangleMesh result;
    std::map<std::array<double, 3>, uint32_t> index;
    for (const auto& t : mesh.triangles) {
        std::array<uint32_t, 3> corners{};
        for (size_t i = 0; i < 3; ++i) {
            const auto& p = mesh.positions[t[i]];
            const auto [it, is_new] = index.emplace(p, static_cast<uint32_t>(result.positions.size()));
            if (is_new) result.positions.push_back(p);
            corners[i] = it->second;
        }
        result.triangles.push_back(corners);
    }
    return result;
}

TriangleMesh both(const TriangleMesh& a, const TriangleMesh& b) { return corpus::together({a, b}, 0); }

// A cube of edge 1 with its lowest corner at the origin.
TriangleMesh cube() {
    const TriangleMesh raw = box(1, 1, 1);
    std::array<double, 3> low = raw.positions[0], high = low;
    for (const auto& p : raw.positions) {
        for (size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    return scaled(moved(raw, -low[0], -low[1], -low[2]), 1 / (high[0] - low[0]));
}

TriangleMesh sheet(uint32_t n, double y_to_z) {  // n x n cells of the unit square, bent into the z direction
    TriangleMesh mesh;
    for (uint32_t r = 0; r <= n; ++r) {
        for (uint32_t c = 0; c <= n; ++c) {
            const double x = double(c) / n, y = double(r) / n;
            mesh.positions.push_back({x, y * std::cos(y_to_z), y * std::sin(y_to_z)});
        }
    }
    for (uint32_t r = 0; r < n; ++r) {
        for (uint32_t c = 0; c < n; ++c) {
            const uint32_t a = r * (n + 1) + c, b = a + 1, d = a + n + 1, e = d + 1;
            mesh.triangles.push_back({a, b, e});
            mesh.triangles.push_back({a, e, d});
        }
    }
    return mesh;
}

// The same surface as a file with shared vertices, as triangles without shared vertices, and with the faces backwards.
std::vector<TriangleMesh> forms(const TriangleMesh& mesh) {
    TriangleMesh backwards = indexed(mesh);
    std::reverse(backwards.triangles.begin(), backwards.triangles.end());
    return {indexed(mesh), soup(mesh), backwards};
}

struct Expected {
    uint64_t components = 1, loops = 0;
    double genus = 0;
    double volume = 0;
    Repairs repairs = {};
};

void expect_everywhere(const std::string& name, const TriangleMesh& mesh, const Expected& expected) {
    int form = 0;
    for (const TriangleMesh& input : forms(mesh)) {
        SCOPED_TRACE(name + ", form " + std::to_string(form++));
        const auto result = clean(input, kAny);
        ASSERT_TRUE(result.ok()) << result.error().message;
        const TopologySummary& topology = result.value().report.topology;
        EXPECT_TRUE(topology.manifold);
        EXPECT_EQ(topology.components, expected.components);
        EXPECT_EQ(topology.boundary_loops, expected.loops);
        EXPECT_EQ(topology.genus, expected.genus);
        EXPECT_NEAR(volume_of(result.value().mesh), expected.volume, 1e-6);
        const Repairs &found = result.value().report.repairs, &wanted = expected.repairs;
        EXPECT_EQ(found.nearly_welded, wanted.nearly_welded);
        EXPECT_EQ(found.duplicate_triangles, wanted.duplicate_triangles);
        EXPECT_EQ(found.double_triangles, wanted.double_triangles);
        EXPECT_EQ(found.slivers, wanted.slivers);
        EXPECT_EQ(found.crowded_edges, wanted.crowded_edges);
        EXPECT_EQ(found.cut_edges, wanted.cut_edges);
        EXPECT_EQ(found.split_points, wanted.split_points);
        EXPECT_EQ(found.flipped_triangles, wanted.flipped_triangles);
        EXPECT_EQ(found.inside_out, wanted.inside_out);
        EXPECT_EQ(result.value().source_vertex.size(), result.value().mesh.positions.size());
    }
}

TEST(Repair, PinchedVerticesAreSplit) {
    expect_everywhere("two tetrahedra", corpus::bow_tie(),
                      {.components = 2,
                       .volume = volume_of(clean(corpus::bow_tie(), kAny).value().mesh),
                       .repairs = {.split_points = 1}});
}

TEST(Repair, BodiesThatTouchAlongAnEdgeStayTwoBodies) {
    const TriangleMesh mesh = both(cube(), moved(cube(), 1, 1, 0));
    expect_everywhere("two cubes at an edge", mesh,
                      {.components = 2, .volume = 2, .repairs = {.crowded_edges = 1, .split_points = 2}});
}

TEST(Repair, BodiesThatShareAFaceStayClosed) {
    const TriangleMesh mesh = both(cube(), moved(cube(), 1, 0, 0));
    for (const TriangleMesh& input : forms(mesh)) {
        const auto result = clean(input, kAny);
        ASSERT_TRUE(result.ok());
        EXPECT_TRUE(result.value().report.topology.watertight);
        EXPECT_EQ(result.value().report.topology.components, 2u);
        EXPECT_NEAR(volume_of(result.value().mesh), 2, 1e-9);
    }
}

TEST(Repair, AFinIsCutOffAndTheBodyStaysClosed) {
    TriangleMesh mesh = indexed(cube());
    uint32_t a = 0, b = 0;  // an edge of the cube
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (mesh.positions[v] == std::array<double, 3>{0, 0, 0}) a = v;
        if (mesh.positions[v] == std::array<double, 3>{1, 0, 0}) b = v;
    }
    for (const double z : {-1.0, 0.5}) {  // outside the cube; inside it
        for (const bool flip : {false, true}) {
            TriangleMesh fin = mesh;
            fin.positions.push_back({0.5, z == 0.5 ? 0.5 : -1, z});
            const auto c = static_cast<uint32_t>(fin.positions.size() - 1);
            fin.triangles.push_back(flip ? std::array{b, a, c} : std::array{a, b, c});
            expect_everywhere("fin", fin,
                              {.components = 2,
                               .loops = 1,
                               .genus = 0,
                               .volume = volume_of(clean(fin, kAny).value().mesh),
                               .repairs = {.crowded_edges = 1, .cut_edges = 1, .split_points = 2}});
            const auto result = clean(fin, kAny);
            ASSERT_FALSE(result.value().report.warnings.empty());
            EXPECT_NE(result.value().report.warnings[0].find("1 edge"), std::string::npos);
            EXPECT_EQ(result.value().report.topology.boundary_edges, 3u);
        }
    }
}

TEST(Repair, SheetsThatCrossContinueStraight) {
    // Four half-planes at one edge: two planes.
    TriangleMesh cross = both(sheet(2, 0), sheet(2, 1.5707963267948966));
    cross = both(cross, both(sheet(2, 3.141592653589793), sheet(2, 4.71238898038469)));
    for (auto& p : cross.positions) {
        for (double& x : p) x = std::round(x * 1e6) / 1e6 + 0.0;
    }
    for (const TriangleMesh& input : forms(cross)) {
        const auto result = clean(input, kAny);
        ASSERT_TRUE(result.ok());
        const CleanMesh& made = result.value();
        EXPECT_EQ(made.report.topology.components, 2u);
        EXPECT_EQ(made.report.topology.boundary_loops, 2u);
        EXPECT_EQ(made.report.repairs.crowded_edges, 2u);
        EXPECT_EQ(made.report.repairs.cut_edges, 0u);
        // Each component is flat.
        const Components components = connected_components(made.mesh.triangles, made.mesh.positions.size());
        for (const Mesh& part : split_components(made.mesh, components)) {
            Eigen::AlignedBox3d extent;
            for (const Vec3& p : part.positions) extent.extend(p);
            EXPECT_LT(extent.sizes().minCoeff(), 1e-9);
        }
    }
}

TEST(Repair, ThreeSheetsAtAnEdgeBecomeTwoPieces) {
    const TriangleMesh book = both(both(sheet(3, 0), sheet(3, 2)), sheet(3, 4));
    for (const TriangleMesh& input : forms(book)) {
        const auto result = clean(input, kAny);
        ASSERT_TRUE(result.ok());
        EXPECT_TRUE(result.value().report.topology.manifold);
        EXPECT_EQ(result.value().report.topology.components, 2u);
        EXPECT_EQ(result.value().report.repairs.cut_edges, 3u);
    }
}

TEST(Repair, TheBackOfASheetGoes) {
    const TriangleMesh card = both(sheet(3, 0), turned(sheet(3, 0)));
    expect_everywhere("card", card, {.loops = 1, .repairs = {.double_triangles = 18, .crowded_edges = 0}});
    const TriangleMesh shells = both(corpus::sphere(3), turned(corpus::sphere(3)));
    for (const TriangleMesh& input : forms(shells)) {
        const auto result = clean(input, kAny);
        ASSERT_TRUE(result.ok());
        EXPECT_EQ(result.value().report.topology.components, 1u);
        EXPECT_TRUE(result.value().report.topology.watertight);
        EXPECT_EQ(result.value().report.repairs.double_triangles, 108u);
    }
}

TEST(Repair, CopiesOfFacesGo) {
    const TriangleMesh twice = both(corpus::sphere(3), corpus::sphere(3));
    for (const TriangleMesh& input : {indexed(twice), soup(twice)}) {
        const auto result = clean(input, kAny);
        ASSERT_TRUE(result.ok());
        EXPECT_EQ(result.value().report.topology.components, 1u);
        EXPECT_TRUE(result.value().report.topology.watertight);
        EXPECT_EQ(result.value().report.repairs.duplicate_triangles, 108u);
    }
}

TEST(Repair, CavitiesAndRoomsKeepTheirSide) {
    const double whole = volume_of(clean(corpus::sphere(4), kAny).value().mesh);
    expect_everywhere("ball with a cavity", both(corpus::sphere(4), turned(scaled(corpus::sphere(4), 0.5))),
                      {.components = 2, .volume = whole * 7 / 8, .repairs = {.inside_out = 1}});
    expect_everywhere("room", turned(cube()), {.volume = -1, .repairs = {.inside_out = 1}});
}

TEST(Repair, ClosedSurfacesWithoutASideFaceOutwards) {
    TriangleMesh mixed = cube();
    for (size_t f = 0; f < mixed.triangles.size(); f += 2) std::swap(mixed.triangles[f][1], mixed.triangles[f][2]);
    for (const TriangleMesh& input : forms(mixed)) EXPECT_NEAR(volume_of(clean(input, kAny).value().mesh), 1, 1e-12);
}

TEST(Repair, SliversAreFlippedAndTheSurfaceStaysClosed) {
    // The middle of an edge of the cube is a vertex of one side only. A triangle without area closes the gap.
    TriangleMesh mesh = indexed(cube());
    uint32_t a = 0, b = 0;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (mesh.positions[v] == std::array<double, 3>{0, 0, 0}) a = v;
        if (mesh.positions[v] == std::array<double, 3>{1, 0, 0}) b = v;
    }
    mesh.positions.push_back({0.5, 1e-9, 0});
    const auto m = static_cast<uint32_t>(mesh.positions.size() - 1);
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        auto t = mesh.triangles[f];
        for (size_t i = 0; i < 3; ++i) {
            if (t[i] != a || t[(i + 1) % 3] != b) continue;
            const uint32_t c = t[(i + 2) % 3];
            mesh.triangles[f] = {a, m, c};
            mesh.triangles.push_back({m, b, c});
            mesh.triangles.push_back({a, b, m});
            f = mesh.triangles.size();
            break;
        }
    }
    ASSERT_EQ(mesh.triangles.size(), 14u);
    expect_everywhere("sliver", mesh, {.volume = 1, .repairs = {.slivers = 1}});
    const Mesh made = clean(mesh, kAny).value().mesh;
    for (uint32_t f = 0; f < made.triangles.size(); ++f) EXPECT_GT(face_area(made, f), 0.1);
}

TEST(Repair, CornersThatAreApartByRoundingAreWelded) {
    TriangleMesh noisy = soup(corpus::sphere(4));
    for (size_t v = 0; v < noisy.positions.size(); ++v) {
        for (size_t k = 0; k < 3; ++k) noisy.positions[v][k] += 2e-7 * std::sin(double(7 * v + k));
    }
    const auto result = clean(noisy, kAny);
    ASSERT_TRUE(result.ok());
    EXPECT_TRUE(result.value().report.topology.watertight);
    EXPECT_EQ(result.value().report.topology.vertices, corpus::sphere(4).positions.size());
    EXPECT_GT(result.value().report.repairs.nearly_welded, 0u);
    EXPECT_EQ(result.value().report.warnings.size(), 1u);
    const auto apart = clean(noisy, {.require_connected = false, .weld_tolerance = Length{0, false}});
    EXPECT_EQ(apart.value().report.topology.components, noisy.triangles.size());

    // A gap that is wider than rounding stays, unless it is asked for.
    TriangleMesh gap = noisy;
    for (size_t v = 0; v < gap.positions.size(); ++v) gap.positions[v][0] += 1e-3 * std::sin(double(v));
    EXPECT_GT(clean(gap, kAny).value().report.topology.boundary_edges, 0u);
    const auto closed = clean(gap, {.require_connected = false, .weld_tolerance = Length{0.3, true}});
    ASSERT_TRUE(closed.ok());
}

TEST(Repair, OneSidedSurfacesAreCutOpen) {
    // Six vertices, ten triangles: the projective plane.
    TriangleMesh plane;
    for (int v = 0; v < 6; ++v)
        plane.positions.push_back({std::sin(2.0 * v), std::cos(3.0 * v), std::sin(5.0 * v + 1)});
    plane.triangles = {{0, 1, 4}, {0, 4, 3}, {0, 3, 5}, {0, 5, 2}, {0, 2, 1},
                       {1, 2, 3}, {2, 4, 3}, {2, 5, 4}, {1, 5, 4}, {1, 3, 5}};
    for (const TriangleMesh& mesh : {corpus::moebius_strip(24), plane}) {
        for (const TriangleMesh& input : forms(mesh)) {
            const auto result = clean(input, kAny);
            ASSERT_TRUE(result.ok()) << result.error().message;
            EXPECT_TRUE(result.value().report.topology.manifold);
            EXPECT_EQ(result.value().report.topology.components, 1u);
            EXPECT_EQ(result.value().report.topology.genus, 0);
            EXPECT_GT(result.value().report.repairs.one_sided_cuts, 0u);
            EXPECT_NE(result.value().report.warnings[0].find("only one side"), std::string::npos);
        }
    }
    // Across the strip is shorter than along it.
    const auto strip = clean(corpus::moebius_strip(24), kAny);
    EXPECT_LE(strip.value().report.repairs.one_sided_cuts, 4u);
    EXPECT_EQ(clean(plane, kAny).value().report.repairs.one_sided_cuts, 3u);
}

TEST(Repair, ABodyThatTouchesItselfKeepsDistinctEdges) {
    // Four cubes in a ring around an edge that two of them share, so that both ends of the edge are one fan each.
    TriangleMesh ring = both(cube(), moved(cube(), 1, 1, 0));
    for (const TriangleMesh& input : forms(both(ring, moved(cube(), 0, 1, 1)))) {
        const auto result = clean(input, kAny);
        ASSERT_TRUE(result.ok());
        EXPECT_TRUE(result.value().report.topology.watertight);
        EXPECT_NEAR(volume_of(result.value().mesh), 3, 1e-9);
        EXPECT_EQ(result.value().report.topology.nonmanifold_edges, 0u);
    }
}

TEST(Repair, StrictRefusesWhatIsRepaired) {
    const CleanOptions strict = {.require_connected = false, .strict = true};
    const auto fails = [&](const TriangleMesh& mesh, const std::string& words) {
        const auto result = clean(mesh, strict);
        return !result.ok() && result.error().message.find(words) != std::string::npos;
    };
    EXPECT_TRUE(fails(corpus::edge_with_three_faces(), "edge 0-1 at (0, 0, 0.5) has 3 faces"));
    EXPECT_TRUE(fails(corpus::bow_tie(), "vertex 0 at (0, 0, 0)"));
    EXPECT_TRUE(fails(corpus::moebius_strip(12), "only one side"));
    EXPECT_TRUE(clean(soup(corpus::sphere(3)), strict).ok());
}

TEST(Repair, BrokenModelsBecomeManifolds) {
    for (const char* name : {"broken-hornbug", "broken-monk", "broken-shark"}) {
        const auto input = load_model(std::string(name) + ".ply");
        if (!input) GTEST_SKIP() << "no development models in " << GIM_MODELS_DIR;
        const auto from_file = clean(*input, kAny), from_soup = clean(soup(*input), kAny);
        ASSERT_TRUE(from_file.ok()) << name << ": " << from_file.error().message;
        ASSERT_TRUE(from_soup.ok()) << name << ": " << from_soup.error().message;
        const TopologySummary &a = from_file.value().report.topology, &b = from_soup.value().report.topology;
        EXPECT_TRUE(a.manifold) << name;
        EXPECT_EQ(a.components, b.components) << name;
        EXPECT_EQ(a.boundary_loops, b.boundary_loops) << name;
        EXPECT_EQ(a.genus, b.genus) << name;
    }
}

}  // namespace
}  // namespace gim
