#include "encoder/squares/square_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "encoder/base/parallel.h"
#include "encoder/code/decode_surface.h"
#include "encoder/squares/square_codec.h"
#include "encoder/squares/write_squares.h"
#include "encoder/surface/compare_meshes.h"
#include "tests/encoder/fit/bumpy_torus.h"

namespace gim {
namespace {

using namespace test;

constexpr uint32_t kSide = 257;  // the smallest one that is fitted from coarse to fine

std::vector<Vec3> from_coarse_to_fine(const SquareImage& start, const Mesh& reference, const Units& units) {
    return SquareFit(start, reference, 1).run(units, CodedFit::Effort::kFinal);
}

std::vector<Vec3> at_one_side(const SquareImage& start, const Mesh& reference, const Units& units) {
    return CodedFit(start, square_codec(start.side(), file_seams(start)), reference, 1)
        .run(units, CodedFit::Effort::kFinal);
}

struct Rated {
    double bytes, psnr;
};

Rated rate(SquareImage image, std::vector<Vec3> positions, const Mesh& reference, const Units& units) {
    image.positions = std::move(positions);
    CodingParameters parameters = lossy(double{units.quantizer});
    parameters.units = units;
    const std::vector<uint8_t> bytes = write_squares({&image, 1}, parameters).value();
    const auto comparison =
        ReferenceSurface(reference).compare(decode_surface(bytes, 0).value(), {.samples = 100000}).value();
    return {double(bytes.size()), comparison.psnr};
}

TEST(SquareFit, GluedSamplesStayEqualAndThreadsChangeNothing) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = torus_on(reference, kSide);
    const Units units = units_for(start, 16);
    std::vector<std::vector<Vec3>> results;
    for (const uint32_t threads : {1u, 3u})
        with_threads(threads, [&] { results.push_back(from_coarse_to_fine(start, reference, units)); });
    EXPECT_EQ(results[0], results[1]);
    EXPECT_NE(results[0], start.positions);
    for (size_t v = 0; v < results[0].size(); ++v)
        ASSERT_EQ(results[0][v], results[0][start.gluing.representative[v]]) << v;
}

TEST(SquareFit, FilesAreAsSmallAndAsNearAsThoseFittedAtOneSide) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = torus_on(reference, kSide);
    const Units units = units_for(start, 16);
    const Rated once = rate(start, at_one_side(start, reference, units), reference, units);
    const Rated twice = rate(start, from_coarse_to_fine(start, reference, units), reference, units);
    EXPECT_LT(twice.bytes, 1.03 * once.bytes);
    EXPECT_GT(twice.psnr, once.psnr - 0.2);
}

// Every second sample is then many steps of the quantizer off.
TEST(SquareFit, AllRoundsRunAtTheFullSideIfTheQuantizerIsFine) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = torus_on(reference, kSide);
    const Units units = units_for(start, 0.05);
    EXPECT_EQ(from_coarse_to_fine(start, reference, units), at_one_side(start, reference, units));
}

TEST(SquareFit, ProgressRises) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = torus_on(reference, kSide);
    std::vector<double> heard;
    (void)SquareFit(start, reference, 1)
        .run(units_for(start, 16), CodedFit::Effort::kFinal, [&](Stage stage, double fraction) {
            EXPECT_EQ(stage, Stage::kFit);
            heard.push_back(fraction);
            return true;
        });
    EXPECT_EQ(heard.size(), 29u);
    EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
    EXPECT_LE(heard.back(), 1.0);
}

}  // namespace
}  // namespace gim
