#include "encoder/tiles/tile_pyramid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "encoder/code/wavelet_analysis.h"
#include "tests/encoder/tiles/made_tiles.h"

namespace gim {
namespace {

using namespace gim::test;

// A complex with an image: f(sample) for each sample and component.
template <class Sample, class F>
std::vector<Sample> grids_of(const CodedComplex& coded, const QuadComplex& complex, uint32_t exponent, const F& f) {
    std::vector<Sample> grids;
    for (const uint32_t s : coded_samples(coded, complex, 1u << exponent))
        for (uint32_t k = 0; k < 3; ++k) grids.push_back(f(s, k));
    return grids;
}

template <class F>
void for_each_complex(const F& f) {
    for (const MadeQuads& made : all_made_quads()) {
        SCOPED_TRACE(made.name);
        const auto complex = complex_of(made.quads, static_cast<uint32_t>(made.corners.size()));
        ASSERT_TRUE(complex.ok());
        const CodedComplex coded = code_complex(bilinear_tiles(made, 1), complex.value().view());
        f(made, coded, complex.value().view());
    }
}

template <class Wavelet>
void expect_perfect_reconstruction(double tolerance) {
    using Sample = typename Wavelet::Sample;
    for_each_complex([&](const MadeQuads&, const CodedComplex& coded, const QuadComplex& complex) {
        for (const uint32_t exponent : {1u, 2u, 4u}) {
            const auto grids = grids_of<Sample>(coded, complex, exponent, [](uint32_t s, uint32_t k) {
                std::minstd_rand random(3 * s + k + 1);
                random.discard(3);
                return static_cast<Sample>(random() % 4096);
            });
            const auto pyramid = analyse_tiles<Wavelet>(coded.complex.view(), grids, exponent);
            const auto back = restore_tiles<Wavelet>(coded.complex.view(), pyramid);
            ASSERT_EQ(back.size(), grids.size());
            for (size_t i = 0; i < back.size(); ++i)
                ASSERT_NEAR(static_cast<double>(back[i]), static_cast<double>(grids[i]), tolerance);
        }
    });
}

TEST(TilePyramid, ReconstructionIsPerfect) {
    expect_perfect_reconstruction<Tiles53>(0);
    expect_perfect_reconstruction<Tiles97>(0.05);
    expect_perfect_reconstruction<TilesSharp>(0.01);
}

TEST(TilePyramid, HostileIntegersWrapAndComeBack) {
    for_each_complex([](const MadeQuads&, const CodedComplex& coded, const QuadComplex& complex) {
        const auto grids = grids_of<int32_t>(coded, complex, 3, [](uint32_t s, uint32_t k) {
            std::minstd_rand random(3 * s + k + 1);
            random.discard(3);
            return static_cast<int32_t>(2 * random());
        });
        const auto pyramid = analyse_tiles<Tiles53>(coded.complex.view(), grids, 3);
        EXPECT_EQ(restore_tiles<Tiles53>(coded.complex.view(), pyramid), grids);
    });
}

TEST(TilePyramid, ConstantsHaveNoDetailsAndKeepTheirValue) {
    for_each_complex([](const MadeQuads&, const CodedComplex& coded, const QuadComplex& complex) {
        const auto check = [&](const auto& pyramid, double tolerance) {
            for (const auto& details : pyramid.details)
                for (const auto d : details) ASSERT_NEAR(static_cast<double>(d), 0, tolerance);
            for (const auto b : pyramid.base) ASSERT_NEAR(static_cast<double>(b), 700, tolerance);
        };
        const auto floats = grids_of<float>(coded, complex, 4, [](uint32_t, uint32_t) { return 700.0f; });
        const auto integers = grids_of<int32_t>(coded, complex, 4, [](uint32_t, uint32_t) { return 700; });
        check(analyse_tiles<Tiles97>(coded.complex.view(), floats, 4), 2e-3);
        check(analyse_tiles<TilesSharp>(coded.complex.view(), floats, 4), 1e-3);
        check(analyse_tiles<Tiles53>(coded.complex.view(), integers, 4), 0);
    });
}

TEST(TilePyramid, SlopesHaveNoDetailsWhereTilesAreRegular) {
    // A 5 x 5 strip: details of its middle tile do not see the boundary at the finest step.
    const MadeQuads made = strip(5, 5);
    const auto complex = complex_of(made.quads, static_cast<uint32_t>(made.corners.size()));
    TileImage image = bilinear_tiles(made, 4);
    const CodedComplex coded = code_complex(image, complex.value().view());
    std::vector<Vec3> slope(image.positions.size());
    for (size_t i = 0; i < slope.size(); ++i)
        slope[i] = {100 * image.positions[i][0] + 30 * image.positions[i][1], image.positions[i][1], 5};
    const auto grids = grids_of<float>(coded, complex.value().view(), 4, [&](uint32_t s, uint32_t k) {
        return static_cast<float>(slope[s][static_cast<int>(k)]);
    });
    for (const bool sharp : {false, true}) {
        const auto pyramid = sharp ? analyse_tiles<TilesSharp>(coded.complex.view(), grids, 4)
                                   : analyse_tiles<Tiles97>(coded.complex.view(), grids, 4);
        const size_t each = TilePlanes(8).details();
        for (uint32_t t = 0; t < 25; ++t) {
            if (tile_of(coded.half_edges[4 * t]) != 12) continue;
            for (size_t i = 0; i < each; ++i) ASSERT_NEAR(pyramid.details[3][t * each + i], 0, 1e-3);
        }
    }
}

TEST(TilePyramid, OneTileIsTransformedAsASquare) {
    const MadeQuads made = strip(1, 1);
    const auto complex = complex_of(made.quads, 4);
    const TileImage image = tile_image(made, 5, 0.2);
    const CodedComplex coded = code_complex(image, complex.value().view());
    const auto grids = grids_of<float>(coded, complex.value().view(), 5, [&](uint32_t s, uint32_t k) {
        return static_cast<float>(100 * image.positions[s][static_cast<int>(k)]);
    });
    const auto tiles = analyse_tiles<Tiles97>(coded.complex.view(), grids, 5);
    const auto square = analyse<Irreversible97>(grids, 33);
    for (uint32_t e = 0; e < 5; ++e) {
        const TilePlanes planes(1u << e);
        const AnalysisLevel<float>& level = square.levels[e];
        std::vector<float> expected = level.horizontal;
        expected.insert(expected.end(), level.vertical.begin(), level.vertical.end());
        expected.insert(expected.end(), level.diagonal.begin(), level.diagonal.end());
        ASSERT_EQ(tiles.details[e].size(), expected.size());
        for (size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(tiles.details[e][i], expected[i], 1e-3);
    }
}

TEST(TilePyramid, ManyTilesAreTransformedAsOneSquareInside) {
    // 4 x 4 tiles of 8 intervals, and the same samples as one tile of 32.
    const MadeQuads made = strip(4, 4);
    const auto complex = complex_of(made.quads, 25);
    const TileImage image = bilinear_tiles(made, 3);
    const CodedComplex coded = code_complex(image, complex.value().view());
    const auto height = [](double x, double y, uint32_t k) {
        return static_cast<float>(100 * std::sin(3 * x + k) * std::cos(2 * y - k));
    };
    const auto grids = grids_of<float>(coded, complex.value().view(), 3, [&](uint32_t s, uint32_t k) {
        return height(image.positions[s][0], image.positions[s][1], k);
    });
    std::vector<float> whole;
    for (uint32_t r = 0; r <= 32; ++r)
        for (uint32_t c = 0; c <= 32; ++c)
            for (uint32_t k = 0; k < 3; ++k) whole.push_back(height(c / 8.0, r / 8.0, k));
    const auto tiles = analyse_tiles<Tiles97>(coded.complex.view(), grids, 3);
    const auto square = analyse<Irreversible97>(whole, 33);
    const size_t each = TilePlanes(4).details();
    for (uint32_t t = 0; t < 16; ++t) {
        const uint32_t first = coded.half_edges[4 * t], tile = tile_of(first);
        if (side_of(first) != 0) continue;  // turned
        const size_t diagonal = 2 * 3 * 5 * 4;
        for (uint32_t r = 0; r < 4; ++r) {
            for (uint32_t c = 0; c < 4; ++c) {
                for (uint32_t k = 0; k < 3; ++k) {
                    const size_t row = 4 * (tile / 4) + r, column = 4 * (tile % 4) + c;
                    ASSERT_NEAR(tiles.details[2][t * each + diagonal + 3 * (4 * r + c) + k],
                                square.levels[4].diagonal[3 * (16 * row + column) + k], 1e-3);
                }
            }
        }
    }
}

}  // namespace
}  // namespace gim
