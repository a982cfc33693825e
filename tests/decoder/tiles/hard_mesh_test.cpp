// Meshes of tiles that are split at sharp edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "decoder/tiles/hard_vertices.h"
#include "tests/decoder/vectors.h"

namespace gim {
namespace {

// A complex in memory of its own, with samples.
struct Complex {
    std::vector<uint32_t> numbers;
    std::vector<uint8_t> on_boundary;
    QuadComplex view;
    std::vector<uint32_t> is_sharp, corner, copies;

    Complex(const std::vector<Quad>& quads, uint32_t vertices)
        : numbers(20 * quads.size()),
          on_boundary(4 * quads.size()),
          corner(4 * quads.size()),
          copies(4 * quads.size()) {
        uint32_t* next = numbers.data();
        for (uint32_t** array : {&view.mate, &view.vertex, &view.edge, &view.lower, &view.valence}) {
            *array = next;
            next += 4 * quads.size();
        }
        view.on_boundary = on_boundary.data();
        view.tiles = static_cast<uint32_t>(quads.size());
        std::vector<uint32_t> work(4 * quads.size() + vertices + 1);
        EXPECT_EQ(find_mates(quads, vertices, work, view.mate).kind, QuadFault::Kind::kFine);
        EXPECT_TRUE(number_complex(&view));
        is_sharp.assign(view.edges, 0);
    }
    HardVertices split(uint32_t side) {
        return split_sharp_edges({view, side, nullptr}, is_sharp.data(), corner.data(), copies.data());
    }
    uint32_t shared(uint32_t side) const { return TileSamples(view, side).count(); }
};

Complex cube() { return {{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}, 8}; }
Complex strip() { return {{{0, 1, 4, 3}, {1, 2, 5, 4}}, 6}; }

// Expects samples at one place to be one vertex exactly where no sharp edge separates them.
void expect_sound(Complex& complex, uint32_t side) {
    const HardVertices hard = complex.split(side);
    const TileSamples samples(complex.view, side);
    std::map<uint32_t, uint32_t> shared_of;
    std::vector<uint32_t> numbers(side + 1);
    for (uint32_t t = 0; t < complex.view.tiles; ++t) {
        for (uint32_t row = 0; row <= side; ++row) {
            hard.load(t, row, numbers.data());
            for (uint32_t c = 0; c <= side; ++c) {
                ASSERT_LT(numbers[c], hard.count);
                const uint32_t shared = samples.at(t, row, c);
                ASSERT_EQ(shared_of.try_emplace(numbers[c], shared).first->second, shared);
            }
        }
    }
    EXPECT_EQ(shared_of.size(), hard.count);  // no number is left out
    for (uint32_t h = 0; h < complex.view.half_edges(); ++h) {
        const uint32_t mate = complex.view.mate[h];
        if (mate == kNoMate) continue;
        const bool is_sharp = complex.is_sharp[complex.view.edge[h]];
        for (uint32_t t = 1; t < side; ++t) EXPECT_EQ(hard.along(h, t) == hard.along(mate, side - t), !is_sharp);
        if (!is_sharp) {
            EXPECT_EQ(hard.along(h, 0), hard.along(mate, side));
        }
    }
}

TEST(HardMesh, NothingIsSplitWithoutSharpEdges) {
    Complex c = cube();
    EXPECT_EQ(c.split(4).count, c.shared(4));
    expect_sound(c, 4);
}

TEST(HardMesh, ACubeOfSharpEdgesComesApart) {
    Complex c = cube();
    c.is_sharp.assign(12, 1);
    EXPECT_EQ(c.split(4).count, 6u * 25);
    EXPECT_EQ(c.split(1).count, 24u);
    expect_sound(c, 4);
    expect_sound(c, 1);
}

TEST(HardMesh, OneSharpEdgeSplitsNoCorner) {
    for (uint32_t e = 0; e < 12; ++e) {
        Complex c = cube();
        c.is_sharp[e] = 1;
        EXPECT_EQ(c.split(4).count, c.shared(4) + 3);
        expect_sound(c, 4);
    }
}

TEST(HardMesh, ASharpLoopSplitsItsCorners) {
    for (uint32_t t = 0; t < 6; ++t) {
        Complex c = cube();
        for (uint32_t i = 0; i < 4; ++i) c.is_sharp[c.view.edge[4 * t + i]] = 1;
        EXPECT_EQ(c.split(4).count, c.shared(4) + 4 * 3 + 4);
        expect_sound(c, 4);
    }
}

TEST(HardMesh, EdgesThatEndAtBoundariesSplitThem) {
    Complex c = strip();
    for (uint32_t e = 0; e < c.view.edges; ++e) c.is_sharp[e] = c.view.mate[c.view.lower[e]] != kNoMate;
    EXPECT_EQ(c.split(4).count, c.shared(4) + 3 + 2);
    expect_sound(c, 4);
    // A boundary has one side, sharp or not.
    c.is_sharp.assign(c.is_sharp.size(), 1);
    EXPECT_EQ(c.split(4).count, c.shared(4) + 3 + 2);
}

TEST(HardMesh, EachSideOfASharpEdgeHasItsNormals) {
    const auto file =
        test::read_bytes(std::string(GIM_SOURCE_DIR) + "/spec/vectors/valid/tiles-genus-2-sharp-lossy.gim");
    Decoder decoder;
    DecoderLevel level;
    ASSERT_EQ(decoder.open(file), GIM_OK);
    ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    const size_t most = size_t{level.width} * level.height;
    std::vector<float> positions(3 * most), normals(3 * most);
    std::vector<uint32_t> triangles(size_t{3} * level.triangle_count);
    uint32_t count = 0;
    ASSERT_EQ(decoder.hard_mesh(level, &count, {positions, normals, {}, triangles}), GIM_OK);
    ASSERT_GT(count, level.vertex_count);
    std::map<std::array<float, 3>, std::vector<uint32_t>> at_place;
    for (uint32_t v = 0; v < count; ++v) {
        at_place[{positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]}].push_back(v);
        EXPECT_NEAR(std::hypot(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]), 1, 1e-5);
    }
    size_t bent = 0;  // places where the normals of the sides differ
    for (const auto& [place, vertices] : at_place) {
        if (vertices.size() < 2) continue;
        const float *a = &normals[3 * vertices[0]], *b = &normals[3 * vertices[1]];
        bent += a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < 0.9f;
    }
    EXPECT_GT(bent, 50u);
    // Room for fewer vertices is refused.
    positions.resize(3 * size_t{level.vertex_count});
    EXPECT_EQ(decoder.hard_mesh(level, &count, {positions, {}, {}, {}}), GIM_BAD_ARGUMENT);
}

TEST(HardMesh, FilesWithoutSharpEdgesGiveTheMesh) {
    for (const char* name : {"tiles-cube-lossy", "charts-open-lossy"}) {
        const auto file = test::read_bytes(std::string(GIM_SOURCE_DIR) + "/spec/vectors/valid/" + name + ".gim");
        Decoder decoder;
        DecoderLevel level;
        ASSERT_EQ(decoder.open(file), GIM_OK) << name;
        ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK) << name;
        const size_t most = size_t{level.width} * level.height;
        std::vector<float> positions(3 * most), mesh(3 * size_t{level.vertex_count});
        uint32_t count = 0;
        ASSERT_EQ(decoder.hard_mesh(level, &count, {positions, {}, {}, {}}), GIM_OK) << name;
        ASSERT_EQ(decoder.mesh(level, {mesh, {}, {}, {}}), GIM_OK) << name;
        EXPECT_EQ(count, level.vertex_count) << name;
        positions.resize(3 * size_t{count});
        EXPECT_EQ(positions, mesh) << name;
    }
}

}  // namespace
}  // namespace gim
