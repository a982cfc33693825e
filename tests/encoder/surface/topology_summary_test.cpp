#include "encoder/surface/topology_summary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "corpus/corpus.h"
#include "tests/models.h"

namespace gim {
namespace {

TEST(SummarizeTopology, CountsAClosedSurface) {
    const TopologySummary s = summarize_topology(corpus::torus(10, 6, 1, 0.3));
    EXPECT_EQ(s.vertices, 60u);
    EXPECT_EQ(s.edges, 180u);
    EXPECT_EQ(s.triangles, 120u);
    EXPECT_EQ(s.euler, 0);
    EXPECT_EQ(s.genus, 1);
    EXPECT_TRUE(s.watertight);
}

TEST(SummarizeTopology, UnreferencedVerticesDoNotCount) {
    TriangleMesh mesh = corpus::sphere(3);
    mesh.positions.push_back({5, 5, 5});
    EXPECT_EQ(summarize_topology(mesh).vertices, mesh.positions.size() - 1);
    EXPECT_TRUE(summarize_topology(mesh).watertight);
}

TEST(SummarizeTopology, FindsWhatIsNotAManifold) {
    EXPECT_EQ(summarize_topology(corpus::edge_with_three_faces()).nonmanifold_edges, 1u);
    const TopologySummary tie = summarize_topology(corpus::bow_tie());
    EXPECT_EQ(tie.nonmanifold_vertices, 1u);
    EXPECT_EQ(tie.components, 2u);
    EXPECT_FALSE(tie.manifold);
    EXPECT_TRUE(std::isnan(tie.genus));
}

TEST(SummarizeTopology, SeesFacesThatDisagree) {
    TriangleMesh mesh = corpus::sphere(3);
    std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
    const TopologySummary s = summarize_topology(mesh);
    EXPECT_EQ(s.misoriented_edges, 3u);
    EXPECT_FALSE(s.manifold);
    EXPECT_GT(summarize_topology(corpus::moebius_strip(12)).misoriented_edges, 0u);
    EXPECT_EQ(summarize_topology(corpus::moebius_strip(12)).boundary_loops, 1u);
}

TEST(SummarizeTopology, MissingVerticesAreNotAManifold) {
    TriangleMesh mesh = corpus::sphere(3);
    mesh.triangles.push_back({0, 1, 100000});
    EXPECT_FALSE(summarize_topology(mesh).manifold);
    EXPECT_EQ(summarize_topology(TriangleMesh{}).triangles, 0u);
    EXPECT_FALSE(summarize_topology(TriangleMesh{}).watertight);
}

TEST(Components, TogetherTheyAreTheWholeMesh) {
    const TriangleMesh input = corpus::corpus().named("four-pieces").mesh();
    Mesh mesh;
    for (const auto& p : input.positions) mesh.positions.emplace_back(p[0], p[1], p[2]);
    mesh.triangles = input.triangles;
    const Components components = connected_components(mesh.triangles, mesh.positions.size());
    ASSERT_EQ(components.count, 4u);
    size_t faces = 0, vertices = 0;
    for (const Mesh& piece : split_components(mesh, components)) {
        EXPECT_EQ(connected_components(piece.triangles, piece.positions.size()).count, 1u);
        faces += piece.triangles.size();
        vertices += piece.positions.size();
    }
    EXPECT_EQ(faces, mesh.triangles.size());
    EXPECT_EQ(vertices, mesh.positions.size());
}

// The figures in the models' own list, which two other programs made.
struct ModelFigures {
    const char* name;
    uint64_t vertices, triangles, components, loops;
    int64_t euler;
    uint64_t bad_edges, bad_vertices;
};

TEST(SummarizeTopology, AgreesWithTheListOfDevelopmentModels) {
    const ModelFigures figures[] = {
        {"bunny", 34834, 69451, 1, 5, -3, 0, 0},
        {"bunny-closed", 34835, 69666, 1, 0, 2, 0, 0},
        {"horse", 48485, 96966, 1, 0, 2, 0, 0},
        {"feline", 49864, 99732, 1, 0, -2, 0, 0},
        {"dragon", 50000, 100000, 1, 0, 0, 0, 0},
        {"gargoyle", 50002, 100000, 1, 0, 2, 0, 0},
        {"teapot", 3242, 6320, 4, 6, 2, 0, 0},
        {"fandisk", 6475, 12946, 1, 0, 2, 0, 0},
        {"igea", 134345, 268686, 1, 0, 2, 0, 0},
        {"venus", 50002, 100000, 1, 0, 2, 0, 0},
        {"rocker-arm", 10044, 20088, 1, 0, 0, 0, 0},
        {"three-torus", 6652, 13312, 1, 0, -4, 0, 0},
        {"david", 30690, 61392, 1, 0, -6, 0, 0},
        {"hand", 50085, 100170, 1, 0, 0, 0, 0},
        {"laurana", 25126, 49954, 1, 4, -2, 0, 0},
        {"mask", 31756, 62460, 1, 1, 1, 0, 0},
        {"mask-holes", 4291, 8288, 1, 7, -5, 0, 0},
        {"terrain-sthelens", 145360, 289170, 1, 1, 1, 0, 0},
        {"flange-genus13", 38396, 76840, 1, 0, -24, 0, 0},
        {"bones", 2154, 4204, 26, 0, 52, 0, 0},
        {"cow", 4315, 8626, 1, 0, 2, 0, 0},
        {"eight", 766, 1536, 1, 0, -2, 0, 0},
        {"block", 2132, 4272, 1, 0, -4, 0, 0},
        {"broken-monk", 29794, 59589, 5, 1, -4, 1, 7},
        {"broken-shark", 27207, 53709, 5, 20, -57, 0, 42},
        {"broken-hornbug", 1460, 1884, 120, 146, 92, 0, 2},
        {"spot-textured", 2930, 5856, 1, 0, 2, 0, 0},
        {"feline-color", 20531, 41066, 1, 0, -2, 0, 0},
    };
    for (const ModelFigures& expected : figures) {
        const auto mesh = load_model(std::string(expected.name) + ".ply");
        if (!mesh) GTEST_SKIP() << "no development models in " << GIM_MODELS_DIR;
        const TopologySummary s = summarize_topology(*mesh);
        EXPECT_EQ(s.vertices, expected.vertices) << expected.name;
        EXPECT_EQ(s.triangles, expected.triangles) << expected.name;
        EXPECT_EQ(s.components, expected.components) << expected.name;
        EXPECT_EQ(s.boundary_loops, expected.loops) << expected.name;
        EXPECT_EQ(s.euler, expected.euler) << expected.name;
        EXPECT_EQ(s.nonmanifold_edges, expected.bad_edges) << expected.name;
        EXPECT_EQ(s.nonmanifold_vertices, expected.bad_vertices) << expected.name;
        EXPECT_EQ(s.misoriented_edges, 0u) << expected.name;
    }
}

}  // namespace
}  // namespace gim
