// The base of a complex: what its vertices are expected to be, and their code.
#include "format/tile_base.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "decoder/pyramid/range_decoder.h"
#include "encoder/code/range_encoder.h"
#include "encoder/tiles/code_complex.h"
#include "tests/encoder/tiles/made_tiles.h"

namespace gim {
namespace {

// A complex in the order of the code, and the places of its vertices.
struct Base {
    OwnComplex complex;
    std::vector<int32_t> values;

    const QuadComplex& view() const { return complex.view(); }
    // The first half-edge of a vertex.
    uint32_t first(uint32_t vertex) const {
        uint32_t h = 0;
        while (view().vertex[h] != vertex) ++h;
        return h;
    }
};

Base base_of(const test::MadeQuads& made, double scale) {
    TileImage image;
    image.quads = made.quads;
    image.vertices = static_cast<uint32_t>(made.corners.size());
    const Result<OwnComplex> complex = complex_of(made.quads, image.vertices);
    CodedComplex coded = code_complex(image, complex.value().view());
    Base base{std::move(coded.complex), std::vector<int32_t>(3 * made.corners.size())};
    for (uint32_t h = 0; h < base.view().half_edges(); ++h) {
        const uint32_t from = coded.half_edges[h];
        const Vec3& p = made.corners[made.quads[tile_of(from)][side_of(from)]];
        for (int k = 0; k < 3; ++k)
            base.values[3 * size_t{base.view().vertex[h]} + size_t(k)] =
                static_cast<int32_t>(std::lround(scale * p[k]));
    }
    return base;
}

std::vector<uint8_t> coded(const Base& base, std::vector<int32_t> values) {
    RangeEncoder coder;
    BandModels models(CoefficientKind::kTiles);
    EXPECT_TRUE(BaseCoder<RangeEncoder>(&coder, &models).code(base.view(), values.data()));
    return coder.finish();
}

TEST(TileBase, AnyValuesComeBack) {
    std::mt19937 random(1);
    for (const test::MadeQuads& made : {test::cube(), test::torus(5, 4), test::strip(4, 3)}) {
        const Base base = base_of(made, 1);
        for (const int32_t most : {0, 1, 1000, kMostBaseValue}) {
            std::vector<int32_t> values(base.values.size());
            for (int32_t& v : values) v = std::uniform_int_distribution<int32_t>(-most, most)(random);
            const std::vector<uint8_t> bytes = coded(base, values);
            std::vector<int32_t> decoded(values.size());
            RangeDecoder decoder(bytes);
            BandModels models(CoefficientKind::kTiles);
            ASSERT_TRUE(BaseCoder<RangeDecoder>(&decoder, &models).code(base.view(), decoded.data()));
            EXPECT_TRUE(decoder.intact());
            EXPECT_EQ(decoded, values) << made.name << ", up to " << most;
        }
    }
}

TEST(TileBase, ExpectationsMoveWithTheSurface) {
    constexpr int32_t far[3] = {70000, -3000, 5};
    for (const test::MadeQuads& made : {test::cube(), test::torus(7, 5), test::strip(4, 3)}) {
        const Base base = base_of(made, 100);
        std::vector<int32_t> moved = base.values;
        for (size_t i = 0; i < moved.size(); ++i) moved[i] += far[i % 3];
        for (uint32_t v = 1; v < base.view().vertices; ++v) {
            const auto place = BasePrediction(base.view(), base.values.data()).of(base.first(v));
            const auto other = BasePrediction(base.view(), moved.data()).of(base.first(v));
            for (size_t k = 0; k < 3; ++k) EXPECT_EQ(other.at[k], place.at[k] + far[k]) << made.name << " " << v;
            EXPECT_EQ(other.doubt, place.doubt);
        }
    }
}

TEST(TileBase, OnlyVerticesBeforeCount) {
    const Base base = base_of(test::torus(7, 5), 100);
    for (uint32_t v = 1; v < base.view().vertices; ++v) {
        std::vector<int32_t> other = base.values;
        for (size_t i = 3 * size_t{v}; i < other.size(); ++i) other[i] = 12345;
        EXPECT_EQ(BasePrediction(base.view(), other.data()).of(base.first(v)).at,
                  BasePrediction(base.view(), base.values.data()).of(base.first(v)).at);
    }
}

TEST(TileBase, TheMoreIsKnownTheNearerIsThePlaceAndTheLessTheDoubt) {
    const Base base = base_of(test::torus(24, 16), 1000);
    double sum[9] = {}, count[9] = {};
    for (uint32_t v = 1; v < base.view().vertices; ++v) {
        const auto place = BasePrediction(base.view(), base.values.data()).of(base.first(v));
        double square = 0;
        for (size_t k = 0; k < 3; ++k) square += std::pow(double(place.at[k]) - base.values[3 * size_t{v} + k], 2);
        sum[place.doubt] += std::sqrt(square);
        count[place.doubt] += 1;
    }
    for (const uint32_t doubt : {3u, 4u, 7u, 8u}) ASSERT_GT(count[doubt], 0) << doubt;
    EXPECT_LT(sum[3] / count[3], sum[4] / count[4]);
    EXPECT_LT(sum[4] / count[4], sum[7] / count[7]);
    EXPECT_LT(sum[7] / count[7], sum[8] / count[8]);
}

TEST(TileBase, AComponentBeginsWhereTheLastOneEnded) {
    test::MadeQuads made = test::cube();
    const auto corners = static_cast<uint32_t>(made.corners.size());
    for (const test::MadeQuads one = made; const Quad& q : one.quads)
        made.quads.push_back({q[0] + corners, q[1] + corners, q[2] + corners, q[3] + corners});
    for (uint32_t v = 0; v < corners; ++v) made.corners.push_back(made.corners[v] + Vec3(5, 0, 0));
    const Base base = base_of(made, 100);
    const auto place = BasePrediction(base.view(), base.values.data()).of(base.first(corners));
    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(place.at[k], base.values[3 * size_t{corners - 1} + k]);
}

TEST(TileBase, ValuesThatNoWriterWritesAreRefused) {
    const Base base = base_of(test::cube(), 1);
    const std::vector<uint8_t> ones(64, 0xFF);  // the longest escapes
    RangeDecoder decoder(ones);
    BandModels models(CoefficientKind::kTiles);
    std::vector<int32_t> values(base.values.size());
    EXPECT_FALSE(BaseCoder<RangeDecoder>(&decoder, &models).code(base.view(), values.data()));
}

}  // namespace
}  // namespace gim
