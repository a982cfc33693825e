#include "format/quad_complex.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace gim {
namespace {

struct Built {
    std::vector<uint32_t> mate, vertex, edge, lower, valence, work;
    std::vector<uint8_t> on_boundary;
    QuadComplex complex;
    QuadFault fault;
    bool numbered = false;

    Built(const std::vector<Quad>& quads, uint32_t vertices)
        : mate(4 * quads.size()),
          vertex(mate.size()),
          edge(mate.size()),
          lower(mate.size()),
          valence(mate.size()),
          work(4 * quads.size() + vertices + 1),
          on_boundary(mate.size()) {
        complex = {static_cast<uint32_t>(quads.size()),
                   0,
                   0,
                   mate.data(),
                   vertex.data(),
                   edge.data(),
                   lower.data(),
                   valence.data(),
                   on_boundary.data()};
        fault = find_mates(quads, vertices, work, mate.data());
        if (fault.kind == QuadFault::Kind::kFine) numbered = number_complex(&complex);
    }
};

TEST(QuadComplex, CubeHasEightVerticesOfValenceThree) {
    const Built b({{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}, 8);
    ASSERT_TRUE(b.numbered);
    EXPECT_EQ(b.complex.vertices, 8u);
    EXPECT_EQ(b.complex.edges, 12u);
    for (uint32_t v = 0; v < 8; ++v) {
        EXPECT_EQ(b.valence[v], 3u);
        EXPECT_FALSE(b.on_boundary[v]);
    }
    for (uint32_t h = 0; h < 24; ++h) EXPECT_EQ(b.mate[b.mate[h]], h);
}

TEST(QuadComplex, SamplesOfSharedSidesAreOne) {
    const Built b({{0, 1, 4, 3}, {1, 2, 5, 4}}, 6);
    ASSERT_TRUE(b.numbered);
    const TileSamples samples(b.complex, 4);
    EXPECT_EQ(samples.count(), 6u + 7 * 3 + 2 * 9);
    for (uint32_t i = 0; i <= 4; ++i) EXPECT_EQ(samples.at(0, i, 4), samples.at(1, i, 0));
    std::set<uint32_t> all;
    for (uint32_t t = 0; t < 2; ++t)
        for (uint32_t r = 0; r <= 4; ++r)
            for (uint32_t c = 0; c <= 4; ++c) all.insert(samples.at(t, r, c));
    EXPECT_EQ(all.size(), samples.count());
    EXPECT_EQ(*all.rbegin(), samples.count() - 1);
}

TEST(QuadComplex, FaultsAreNamed) {
    using Kind = QuadFault::Kind;
    const auto kind = [](const std::vector<Quad>& quads, uint32_t vertices) {
        return Built(quads, vertices).fault.kind;
    };
    EXPECT_EQ(kind({{0, 1, 2, 3}}, 3), Kind::kNoVertex);
    EXPECT_EQ(kind({{0, 1, 0, 3}}, 4), Kind::kRepeated);
    EXPECT_EQ(kind({{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}}, 8), Kind::kCrowdedEdge);
    EXPECT_EQ(kind({{0, 1, 2, 3}}, 5), Kind::kUnusedVertex);
    EXPECT_EQ(kind({{0, 1, 2, 3}, {2, 4, 5, 6}}, 7), Kind::kTouchingTiles);
    EXPECT_EQ(kind({{0, 1, 2, 3}, {3, 2, 1, 0}}, 4), Kind::kFine);
}

TEST(QuadComplex, MatesThatFoldATileOntoItselfAreRefused) {
    Built b({{0, 1, 2, 3}}, 4);
    b.mate = {1, 0, kNoMate, kNoMate};
    b.complex.mate = b.mate.data();
    EXPECT_FALSE(number_complex(&b.complex));
}

}  // namespace
}  // namespace gim
