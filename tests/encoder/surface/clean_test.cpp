#include "encoder/surface/clean.h"

#include <gtest/gtest.h>

#include <string>

#include "corpus/corpus.h"
#include "tests/models.h"

namespace gim {
namespace {

bool says(const Result<CleanMesh>& result, const std::string& words) {
    return !result.ok() && result.error().stage == Stage::kClean &&
           result.error().message.find(words) != std::string::npos;
}

double signed_volume(const Mesh& mesh) {
    double volume = 0;
    for (const Triangle& t : mesh.triangles) {
        volume += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6;
    }
    return volume;
}

TEST(Clean, LeavesGoodMeshesAsTheyAre) {
    for (const corpus::CorpusEntry& entry : corpus::corpus().connected()) {
        const TriangleMesh input = entry.mesh();
        const auto result = clean(input);
        ASSERT_TRUE(result.ok()) << entry.name << ": " << result.error().message;
        EXPECT_EQ(result.value().mesh.triangles, input.triangles) << entry.name;
        EXPECT_EQ(result.value().mesh.positions.size(), input.positions.size()) << entry.name;
        EXPECT_EQ(result.value().report.topology.genus, entry.genus) << entry.name;
    }
}

TEST(Clean, SoupOfEveryGoodMeshComesBackWhole) {
    for (const corpus::CorpusEntry& entry : corpus::corpus().connected()) {
        const TriangleMesh input = entry.mesh();
        const auto result = clean(corpus::soup(input));
        ASSERT_TRUE(result.ok()) << entry.name << ": " << result.error().message;
        EXPECT_EQ(result.value().mesh.positions.size(), input.positions.size()) << entry.name;
        EXPECT_EQ(result.value().report.repairs.welded_vertices, 3 * input.triangles.size() - input.positions.size())
            << entry.name;
        EXPECT_EQ(result.value().report.topology.genus, entry.genus) << entry.name;
    }
}

TEST(Clean, SoupWithCollapsedAndDoubleTrianglesComesBackWhole) {
    TriangleMesh input = corpus::soup(corpus::sphere(4));
    const auto add = [&](size_t a, size_t b, size_t c) {
        const auto first = static_cast<uint32_t>(input.positions.size());
        for (const size_t v : {a, b, c}) input.positions.push_back(std::array<double, 3>(input.positions[v]));
        input.triangles.push_back({first, first + 1, first + 2});
    };
    add(0, 1, 0);     // collapsed onto an edge
    add(30, 31, 32);  // the eleventh triangle again
    const auto result = clean(input);
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_TRUE(result.value().report.topology.watertight);
    EXPECT_EQ(result.value().report.repairs.degenerate_triangles, 1u);
    EXPECT_EQ(result.value().report.repairs.duplicate_triangles, 1u);
}

TEST(Clean, SheetsThatOnlyTouchStayApart) {
    // A soup of two cubes that touch along an edge: an exact weld would give that edge four faces.
    TriangleMesh second = corpus::box(1, 1, 1);
    for (auto& p : second.positions) p = {p[0] + 2, p[1] + 2, p[2]};
    const TriangleMesh both = corpus::soup(corpus::together({corpus::box(1, 1, 1), second}, 0));
    const auto result = clean(both, {.require_connected = false});
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_EQ(result.value().report.topology.components, 2u);
    EXPECT_TRUE(result.value().report.topology.watertight);
}

TEST(Clean, PartsThatTouchInAPointAreNotWelded) {
    // Four quarters around an axis, joined below. Their four upper edges along the axis lie at one place.
    const auto input = load_model("teapot.ply");
    if (!input) GTEST_SKIP() << "no development models in " << GIM_MODELS_DIR;
    const auto result = clean(*input, {.require_connected = false});
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_EQ(result.value().report.repairs.welded_vertices, 0u);
    EXPECT_EQ(result.value().report.topology.components, 4u);
}

TEST(Clean, UselessFacesAndVerticesGo) {
    const auto result = clean(corpus::corpus().named("useless-faces").mesh());
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_EQ(result.value().report.repairs.degenerate_triangles, 1u);
    EXPECT_EQ(result.value().report.repairs.duplicate_triangles, 1u);
    EXPECT_EQ(result.value().report.repairs.unreferenced_vertices, 1u);
    EXPECT_TRUE(result.value().report.topology.watertight);
}

TEST(Clean, CollapsedFacesGoAndTheSurfaceStaysClosed) {
    TriangleMesh input = corpus::sphere(4);
    input.positions[input.triangles[0][0]] = input.positions[input.triangles[0][1]];
    const auto result = clean(input);
    ASSERT_TRUE(result.ok()) << result.error().message;
    EXPECT_EQ(result.value().mesh.triangles.size(), input.triangles.size() - 2);
    EXPECT_EQ(result.value().report.repairs.degenerate_triangles, 2u);
    EXPECT_TRUE(result.value().report.topology.watertight);
}

TEST(Clean, FacesAgreeAndSurfacesKeepTheirSide) {
    const auto mixed = clean(corpus::corpus().named("misoriented").mesh());
    ASSERT_TRUE(mixed.ok()) << mixed.error().message;
    EXPECT_EQ(mixed.value().report.repairs.flipped_triangles, 60u);
    EXPECT_GT(signed_volume(mixed.value().mesh), 0);

    TriangleMesh inward = corpus::limbed_blob(32);
    for (auto& t : inward.triangles) std::swap(t[1], t[2]);
    for (auto& p : inward.positions) p[0] += 1000;
    const auto turned = clean(inward);
    ASSERT_TRUE(turned.ok());
    EXPECT_EQ(turned.value().report.repairs.flipped_triangles, 0u);
    EXPECT_EQ(turned.value().report.repairs.inside_out, 1u);
}

TEST(Clean, OpenSurfacesKeepTheSideOfMostFaces) {
    TriangleMesh input = corpus::terrain(10);
    std::swap(input.triangles[0][0], input.triangles[0][1]);
    const auto result = clean(input);
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result.value().report.repairs.flipped_triangles, 1u);
}

TEST(Clean, BrokenMeshesAreRefusedWithThePlaceAndTheAdvice) {
    const auto result_of = [](const char* name) { return clean(corpus::corpus().named(name).mesh()); };
    EXPECT_TRUE(says(result_of("empty"), "no triangles"));
    EXPECT_TRUE(says(result_of("not-a-number"), "vertex 7 at"));
    EXPECT_TRUE(says(result_of("missing-vertex"), "triangle 11"));
    EXPECT_TRUE(says(result_of("four-pieces"), "4 connected components"));
    EXPECT_TRUE(says(result_of("four-pieces"), "--layout mcgim"));
    EXPECT_TRUE(says(clean({{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}}}), "repeats a vertex"));
}

TEST(Clean, DevelopmentModelsAreTakenOrRefusedAsTheyShould) {
    for (const char* name : {"bunny", "bunny-closed", "horse", "feline", "dragon", "gargoyle", "fandisk", "rocker-arm",
                             "three-torus", "laurana", "mask", "mask-holes", "flange-genus13", "eight", "block"}) {
        const auto input = load_model(std::string(name) + ".ply");
        if (!input) GTEST_SKIP() << "no development models in " << GIM_MODELS_DIR;
        const auto result = clean(*input);
        ASSERT_TRUE(result.ok()) << name << ": " << result.error().message;
        EXPECT_EQ(result.value().mesh.triangles.size(), input->triangles.size()) << name;
        EXPECT_EQ(result.value().report.repairs.welded_vertices + result.value().report.repairs.flipped_triangles, 0u)
            << name;
    }
    EXPECT_TRUE(says(clean(*load_model("teapot.ply")), "4 connected components"));
    EXPECT_TRUE(says(clean(*load_model("bones.ply")), "26 connected components"));
}

}  // namespace
}  // namespace gim
