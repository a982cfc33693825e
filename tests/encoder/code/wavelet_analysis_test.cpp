#include "encoder/code/wavelet_analysis.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "decoder/pyramid/synthesis.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;

// Undoes all levels. bands: integers, as synthesize takes them. steps: what one unit is worth.
template <class Wavelet>
std::vector<typename Wavelet::Sample> synthesize_all(Pyramid<int32_t> bands, const std::vector<DetailSteps>& steps,
                                                     std::vector<typename Wavelet::Sample> image,
                                                     const SeamTable* seams = nullptr) {
    using Sample = typename Wavelet::Sample;
    for (size_t e = 1; e <= bands.levels.size(); ++e) {
        const auto step = static_cast<uint32_t>(e);
        const uint32_t columns = bands.columns_at(step), rows = bands.rows_at(step);
        std::vector<Sample> work(synthesis_work_size(columns)), out(size_t{columns} * rows * 3);
        const OwnSharedRim rim(seams, columns);
        synthesize<Wavelet>(columns, rows, image.data(), bands_of(bands, step - 1), steps[e - 1], work.data(),
                            out.data(), rim.view());
        image = std::move(out);
    }
    return image;
}

TEST(Reversible53, EverySampleComesBackAtEverySide) {
    Random random(1);
    for (const uint32_t side : {3u, 5u, 9u, 17u, 33u, 129u}) {
        std::vector<int32_t> image(size_t{side} * side * 3);
        for (int32_t& v : image) v = static_cast<int32_t>(random.below(1u << 20));
        const Pyramid<int32_t> bands = analyse<Reversible53>(image, side);
        EXPECT_EQ(synthesize_all<Reversible53>(bands, std::vector<DetailSteps>(bands.levels.size()), bands.base),
                  image);
    }
}

TEST(Reversible53, EverySampleComesBackFromRectanglesOfAnySize) {
    Random random(3);
    for (uint32_t columns = 2; columns < 14; ++columns) {
        for (const uint32_t rows : {2u, 3u, 5u, 8u, 31u}) {
            std::vector<int32_t> image(size_t{columns} * rows * 3);
            for (int32_t& v : image) v = static_cast<int32_t>(random.below(1u << 20));
            for (uint32_t steps = 0; steps == 0 || std::min(halved(columns, steps - 1), halved(rows, steps - 1)) >= 2;
                 ++steps) {
                const Pyramid<int32_t> bands = analyse<Reversible53>(image, columns, rows, steps);
                EXPECT_EQ(synthesize_all<Reversible53>(bands, std::vector<DetailSteps>(steps), bands.base), image)
                    << columns << " x " << rows << ", " << steps << " steps";
                if (steps == 4) break;
            }
        }
    }
}

TEST(Reversible53, SmoothImagesHaveSmallBandsAndAMeaningfulCoarserImage) {
    const uint32_t side = 65;
    std::vector<int32_t> image;
    for (uint32_t r = 0; r < side; ++r)
        for (uint32_t c = 0; c < side; ++c)
            image.insert(image.end(), {int32_t(20 * r), int32_t(30 * c), int32_t(10 * r + 7 * c)});
    const Pyramid<int32_t> bands = analyse<Reversible53>(image, side);
    for (const int32_t v : bands.levels.back().diagonal) EXPECT_LE(std::abs(v), 1);
    EXPECT_NEAR(bands.base[1 * 3 + 1], image[(side - 1) * 3 + 1], 400);
}

TEST(Irreversible97, ConstantImagesStayConstantAtEveryLevel) {
    const uint32_t side = 33;
    const std::vector<float> image(size_t{side} * side * 3, 1000.0f);
    const Pyramid<float> bands = analyse<Irreversible97>(image, side);
    for (const float v : bands.base) EXPECT_NEAR(v, 1000.0f, 0.01f);
    for (const auto& l : bands.levels)
        for (const float v : l.diagonal) EXPECT_NEAR(v, 0.0f, 0.001f);
}

TEST(Irreversible97, ConstantRectanglesStayConstantAtEveryLevel) {
    const std::vector<float> image(size_t{30} * 23 * 3, 1000.0f);
    const Pyramid<float> bands = analyse<Irreversible97>(image, 30, 23, 3);
    for (const float v : bands.base) EXPECT_NEAR(v, 1000.0f, 0.01f);
    for (const auto& l : bands.levels)
        for (const float v : l.vertical) EXPECT_NEAR(v, 0.0f, 0.001f);
}

TEST(Irreversible97, FineStepsGiveTheImageBack) {
    Random random(2);
    const uint32_t side = 65;
    const float step = 1.0f / 1024;
    std::vector<float> image(size_t{side} * side * 3);
    for (float& v : image) v = 100 * random.unit();
    const Pyramid<float> real = analyse<Irreversible97>(image, side);
    const auto to_integers = [&](const std::vector<float>& values) {
        std::vector<int32_t> q;
        for (const float v : values) q.push_back(static_cast<int32_t>(std::lround(v / step)));
        return q;
    };
    Pyramid<int32_t> bands;
    bands.columns = bands.rows = side;
    for (const auto& l : real.levels)
        bands.levels.push_back({to_integers(l.horizontal), to_integers(l.vertical), to_integers(l.diagonal)});
    const auto back =
        synthesize_all<Irreversible97>(bands, std::vector<DetailSteps>(real.levels.size(), {step, step}), real.base);
    for (size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(back[i], image[i], 0.02f);
}

SeamTable random_seams(Random& random) {
    SeamTable seams;
    const Sideband sideband = test::random_sideband(random, 9, 1 + random.below(12), random.below(8), false);
    EXPECT_EQ(build_seam_table(sideband, &seams), Status::kOk);
    return seams;
}

std::vector<float> random_image(Random& random, uint32_t side) {
    std::vector<float> image(size_t{side} * side * 3);
    for (float& v : image) v = 100 * random.unit();
    return image;
}

TEST(SharedRim, ImagesComeBackAndTheDecodersInverseIsTheSame) {
    Random random(8);
    const uint32_t side = 65;
    for (int round = 0; round < 20; ++round) {
        const SeamTable seams = random_seams(random);
        const std::vector<float> image = random_image(random, side);
        const Pyramid<float> bands = analyse<Irreversible97>(image, side, &seams);
        const std::vector<float> back = restore<Irreversible97>(bands, &seams);
        for (size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(back[i], image[i], 2e-3f);
        // Without details: the image that the base alone makes.
        Pyramid<float> smooth = bands;
        Pyramid<int32_t> none;
        none.columns = none.rows = side;
        for (auto& l : smooth.levels) {
            none.levels.push_back({std::vector<int32_t>(l.horizontal.size()), std::vector<int32_t>(l.vertical.size()),
                                   std::vector<int32_t>(l.diagonal.size())});
            for (auto* band : {&l.horizontal, &l.vertical, &l.diagonal}) std::fill(band->begin(), band->end(), 0.0f);
        }
        EXPECT_EQ(
            restore<Irreversible97>(smooth, &seams),
            synthesize_all<Irreversible97>(none, std::vector<DetailSteps>(none.levels.size()), bands.base, &seams));
    }
}

TEST(SharedRim, LinearImagesHaveNoDetailsAndCutNodesKeepTheirValues) {
    Random random(9);
    const uint32_t side = 33;
    std::vector<float> image;
    for (uint32_t r = 0; r < side; ++r)
        for (uint32_t c = 0; c < side; ++c)
            image.insert(image.end(), {float(20 * r), float(30 * c), float(10 * r + 7 * c)});
    for (int round = 0; round < 20; ++round) {
        const SeamTable seams = random_seams(random);
        const Pyramid<float> bands = analyse<Irreversible97>(image, side, &seams);
        for (const auto& l : bands.levels) {
            for (const auto* band : {&l.horizontal, &l.vertical, &l.diagonal})
                for (const float v : *band) ASSERT_NEAR(v, 0, 2e-3f);
        }
        const std::vector<float> noise = random_image(random, side);
        const std::vector<float> half = analyse<Irreversible97>(noise, side, side, 1, &seams).base;
        for (uint32_t path = 0; path < seams.path_count; ++path) {
            const uint32_t node = seams.first[path] % ring_length(9);
            const GridPoint p = ring_point(side, 4 * node), q = ring_point(17, 2 * node);
            for (size_t k = 0; k < 3; ++k)
                EXPECT_NEAR(half[(q.row * 17 + q.column) * 3 + k], noise[(p.row * side + p.column) * 3 + k], 1e-4f);
        }
    }
}

// This is why coding them once is right.
TEST(SharedRim, BothSidesOfACutPathHaveTheSameDetails) {
    Random random(10);
    const uint32_t side = 65;
    for (int round = 0; round < 20; ++round) {
        const SeamTable seams = random_seams(random);
        std::vector<float> image = random_image(random, side);
        std::vector<uint32_t> classes(ring_length(side)), first(ring_length(side), UINT32_MAX);
        ring_classes(seams, side, classes);
        for (uint32_t k = 0; k < classes.size(); ++k) {
            const GridPoint p = ring_point(side, k);
            const uint32_t at = p.row * side + p.column;
            if (first[classes[k]] == UINT32_MAX) first[classes[k]] = at;
            std::copy_n(&image[3 * first[classes[k]]], 3, &image[3 * at]);
        }
        const Pyramid<float> bands = analyse<Irreversible97>(image, side, &seams);
        for (uint32_t step = 1; step <= bands.steps(); ++step) {
            const OwnSharedRim rim(&seams, bands.columns_at(step));
            const AnalysisLevel<float>& l = bands.levels[step - 1];
            const uint32_t lows = low_count(bands.columns_at(step)), highs = lows - 1;
            const auto detail = [&](Orientation o, uint32_t row, uint32_t column) {
                return o == Orientation::kHorizontal ? &l.horizontal[(row * highs + column) * 3]
                                                     : &l.vertical[(row * lows + column) * 3];
            };
            rim.view().for_each_copy([&](Orientation o, uint32_t row, uint32_t column) {
                const DetailPlace from = rim.view().source_of(o, row, column);
                for (size_t k = 0; k < 3; ++k)
                    EXPECT_NEAR(detail(o, row, column)[k], detail(from.orientation, from.row, from.column)[k], 1e-3f);
            });
        }
    }
}

// The quantizer steps rest on the norms of the synthesis functions: a unit coefficient in the middle of a band.
TEST(BandNorms, AreThoseOfTheSynthesisFunctions) {
    const uint32_t side = 257, exponent = 8;
    for (uint32_t depth = 1; depth <= 4; ++depth) {
        for (const auto orientation : {Orientation::kHorizontal, Orientation::kVertical, Orientation::kDiagonal}) {
            Pyramid<int32_t> bands;
            bands.columns = bands.rows = side;
            for (uint32_t e = 1; e <= exponent; ++e) {
                const size_t h = size_t{1} << (e - 1);
                bands.levels.push_back({std::vector<int32_t>((h + 1) * h * 3), std::vector<int32_t>(h * (h + 1) * 3),
                                        std::vector<int32_t>(h * h * 3)});
            }
            AnalysisLevel<int32_t>& l = bands.levels[exponent - depth];
            const size_t h = size_t{1} << (exponent - depth),
                         columns = orientation == Orientation::kVertical ? h + 1 : h;
            auto& band = orientation == Orientation::kHorizontal ? l.horizontal
                         : orientation == Orientation::kVertical ? l.vertical
                                                                 : l.diagonal;
            band[(h / 2 * columns + h / 2) * 3] = 1;
            const auto image = synthesize_all<Irreversible97>(bands, std::vector<DetailSteps>(exponent, {1, 1}),
                                                              std::vector<float>(12, 0.0f));
            double energy = 0;
            for (const float v : image) energy += double{v} * double{v};
            const double norm = std::sqrt(energy) / double{1 + kReconstructionShift};
            const BandNorms& n = kBandNorms[depth - 1];
            EXPECT_NEAR(norm / double{orientation == Orientation::kDiagonal ? n.diagonal : n.edge}, 1, 1e-3) << depth;
        }
    }
}

}  // namespace
}  // namespace gim
