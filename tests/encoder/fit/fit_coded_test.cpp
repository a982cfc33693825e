#include "encoder/fit/fit_coded.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "encoder/base/parallel.h"
#include "encoder/code/decode_surface.h"
#include "encoder/image/gluing.h"
#include "encoder/squares/square_codec.h"
#include "encoder/squares/write_squares.h"
#include "encoder/surface/compare_meshes.h"
#include "tests/encoder/fit/bumpy_torus.h"

namespace gim {
namespace {

using namespace test;

constexpr uint32_t kSide = 65;

// Samples of the torus put onto the reference, and fitted to it.
SquareImage image_on(const Mesh& reference) {
    SquareImage image = torus_on(reference, kSide);
    image.positions = fit(image, reference, {.strength = FitOptions::Strength::kStiff}).value().positions;
    return image;
}

SquareImage fitted(const SquareImage& start, const Mesh& reference, const Units& units,
                   CodedFit::Effort effort = CodedFit::Effort::kFinal) {
    CodedFit fit(start, square_codec(start.side(), file_seams(start)), reference, 1);
    SquareImage image = start;
    image.positions = fit.run(units, effort);
    return image;
}

TEST(FitCoded, GluedSamplesStayEqual) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = image_on(reference);
    for (const auto effort : {CodedFit::Effort::kSearch, CodedFit::Effort::kFinal}) {
        const SquareImage image = fitted(start, reference, units_for(start, 16), effort);
        ASSERT_EQ(image.positions.size(), start.positions.size());
        EXPECT_NE(image.positions, start.positions);
        for (size_t v = 0; v < image.positions.size(); ++v)
            ASSERT_EQ(image.positions[v], image.positions[start.gluing.representative[v]]) << v;
    }
}

TEST(FitCoded, ThreadsAndRepetitionChangeNothing) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = image_on(reference);
    const Units units = units_for(start, 16);
    std::vector<std::vector<Vec3>> results;
    for (const uint32_t threads : {1u, 2u, 3u}) {
        with_threads(threads,
                     [&] { results.push_back(fitted(start, reference, units, CodedFit::Effort::kSearch).positions); });
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

// The steps of the fit fold nothing over. The quantizer, which makes the final image, does here and there.
TEST(FitCoded, HardlyAnythingFoldsThatWasNotFoldedBefore) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = image_on(reference);
    const uint64_t before = measure_fit(start, reference).value().folds;
    // Single fits are up to 20 off with any codec, because finer ones find creases. The mean tells more.
    uint64_t sum = 0;
    for (const double quantizer : {4.0, 8.0, 16.0, 64.0}) {
        const SquareImage image = fitted(start, reference, units_for(start, quantizer));
        sum += measure_fit(image, reference).value().folds;
    }
    EXPECT_LE(sum / 4, before + kSide * kSide / 500);
}

TEST(FitCoded, FilesAreSmallerAtTheSameErrorThanThoseOfTheStart) {
    const Mesh reference = bumpy_torus();
    const ReferenceSurface surface(reference);
    const SquareImage start = image_on(reference);
    const auto psnr = [&](const std::vector<uint8_t>& bytes) {
        return surface.compare(decode_surface(bytes, 0).value(), {.samples = 50000}).value().psnr;
    };
    for (const double quantizer : {8.0, 32.0}) {
        const Units units = units_for(start, quantizer);
        const SquareImage image = fitted(start, reference, units);
        CodingParameters parameters = lossy(quantizer);
        parameters.units = units;
        const std::vector<uint8_t> bytes = write_squares({&image, 1}, parameters).value();
        const double reached = psnr(bytes);
        // The largest quantizer that is as good without the fit.
        size_t needed = 0;
        for (double other = 4 * quantizer; needed == 0 && other > 1; other /= 1.1) {
            parameters.quantizer = other;
            const std::vector<uint8_t> plain = write_squares({&start, 1}, parameters).value();
            if (psnr(plain) >= reached) needed = plain.size();
        }
        EXPECT_LT(double(bytes.size()), 0.9 * double(needed)) << quantizer;
    }
}

TEST(FitCoded, ProgressRises) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = image_on(reference);
    std::vector<double> heard;
    (void)CodedFit(start, square_codec(start.side(), file_seams(start)), reference, 1)
        .run(units_for(start, 16), CodedFit::Effort::kSearch, [&](Stage stage, double fraction) {
            EXPECT_EQ(stage, Stage::kFit);
            heard.push_back(fraction);
            return true;
        });
    ASSERT_GE(heard.size(), 3u);
    EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
    EXPECT_LE(heard.back(), 1.0);
}

}  // namespace
}  // namespace gim
