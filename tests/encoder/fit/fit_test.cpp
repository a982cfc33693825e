#include "encoder/fit/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "corpus/generators.h"
#include "encoder/image/gluing.h"
#include "encoder/surface/closest_point.h"
#include "tests/encoder/fit/bumpy_torus.h"
#include "tests/encoder/grid_images.h"
#include "tests/models.h"

namespace gim {
namespace {

using test::bumpy_torus;
using test::torus_on;

// A bent sheet with a sharp crease at x = 0.1, bounded by a square.
double height(double x, double y) { return 0.5 * std::abs(x - 0.1) + 0.1 * y * y; }
Mesh creased_sheet() {
    TriangleMesh sheet = corpus::terrain(60);
    for (auto& p : sheet.positions) p[2] = height(p[0], p[1]);
    return mesh_of(sheet);
}
SquareImage sheet_image(uint32_t side) {
    return image_of(side, open_sideband(), [](double u, double v) {
        const double x = 2 * u - 1, y = 2 * v - 1;
        return Vec3(x, y, height(x, y));
    });
}

double decibels(double better, double worse) { return 20 * std::log10(worse / better); }

TEST(Fit, ComesNearerBothWays) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = torus_on(reference, 65);
    for (const auto strength : {FitOptions::Strength::kStiff, FitOptions::Strength::kLoose}) {
        const auto result = fit(start, reference, {.strength = strength, .rounds = 6});
        ASSERT_TRUE(result.ok()) << result.error().message;
        const Fitted& fitted = result.value();
        EXPECT_TRUE(fitted.improved);
        EXPECT_GT(decibels(fitted.after.to_image, fitted.before.to_image), 2);
        EXPECT_GT(decibels(fitted.after.to_reference, fitted.before.to_reference), 2);
        EXPECT_LE(fitted.after.folds, fitted.before.folds);
    }
}

TEST(Fit, OneFoldInThousandsOfSamplesMayComeWithIt) {
    const Mesh reference = bumpy_torus();
    for (const uint32_t side : {65u, 129u}) {
        const SquareImage start = torus_on(reference, side);
        const Fitted fitted = fit(start, reference, {.strength = FitOptions::Strength::kLoose, .rounds = 8}).value();
        EXPECT_TRUE(fitted.improved);
        EXPECT_LE(fitted.after.folds, std::max<uint64_t>(fitted.before.folds, side * side / 8000));
    }
}

TEST(Fit, ReportsWhatAnIndependentMeasurementFinds) {
    const Mesh reference = bumpy_torus();
    SquareImage fitted = torus_on(reference, 33);
    const auto result = fit(fitted, reference, {});
    ASSERT_TRUE(result.ok());
    fitted.positions = result.value().positions;
    const auto quality = measure_fit(fitted, reference);
    ASSERT_TRUE(quality.ok());
    EXPECT_NEAR(decibels(quality.value().to_image, result.value().after.to_image), 0, 1e-6);

    TriangleMesh image, input;
    for (const Vec3& p : result.value().positions) image.positions.push_back({p[0], p[1], p[2]});
    image.triangles = triangulate_grid(result.value().positions, fitted.gluing).triangles;
    for (const Vec3& p : reference.positions) input.positions.push_back({p[0], p[1], p[2]});
    input.triangles = reference.triangles;
    const auto comparison = compare(input, image, {});
    ASSERT_TRUE(comparison.ok());
    EXPECT_NEAR(decibels(comparison.value().rms_to_test, result.value().after.to_image), 0, 0.1);
    EXPECT_NEAR(decibels(comparison.value().rms_to_reference, result.value().after.to_reference), 0, 0.1);
}

TEST(Fit, SeamsStayClosed) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = torus_on(reference, 33);
    const auto result = fit(start, reference, {});
    ASSERT_TRUE(result.ok());
    ASSERT_TRUE(result.value().improved);
    for (size_t v = 0; v < result.value().positions.size(); ++v) {
        EXPECT_EQ(result.value().positions[v], result.value().positions[start.gluing.representative[v]]);
    }
}

TEST(Fit, ThreadsAndRepetitionChangeNothing) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = torus_on(reference, 65);
    const auto one = fit(start, reference, {.rounds = 4, .threads = 1}),
               two = fit(start, reference, {.rounds = 4, .threads = 2});
    ASSERT_TRUE(one.ok() && two.ok());
    EXPECT_TRUE(one.value().improved);
    EXPECT_EQ(one.value().positions, two.value().positions);
    EXPECT_NE(one.value().positions, fit(start, reference, {.rounds = 4, .seed = 2}).value().positions);
}

TEST(Fit, SideOfTheImageDoesNotMatter) {
    // The same samples with rows and columns exchanged look inwards.
    const Mesh reference = bumpy_torus();
    const SquareImage start = torus_on(reference, 33);
    SquareImage turned = start;
    for (uint32_t row = 0; row < 33; ++row) {
        for (uint32_t column = 0; column < 33; ++column) turned.at(column, row) = start.at(row, column);
    }
    const auto straight = fit(start, reference, {}), exchanged = fit(turned, reference, {});
    EXPECT_TRUE(exchanged.value().improved);
    EXPECT_NEAR(decibels(straight.value().after.to_image, exchanged.value().after.to_image), 0, 1);
    EXPECT_EQ(straight.value().before.folds, exchanged.value().before.folds);
}

TEST(Fit, BoundarySamplesStayOnTheBoundaryCurve) {
    const Mesh reference = creased_sheet();
    const auto result = fit(sheet_image(33), reference, {});
    ASSERT_TRUE(result.ok()) << result.error().message;
    ASSERT_TRUE(result.value().improved);
    for (uint32_t k = 0; k < 33; ++k) {
        for (const uint32_t v : {k, k * 33 + 32, 32 * 33 + k, k * 33}) {
            const Vec3& p = result.value().positions[v];
            EXPECT_NEAR(std::max(std::abs(p[0]), std::abs(p[1])), 1, 1e-9);
        }
    }
}

TEST(Fit, LooseSamplesFindTheCrease) {
    const Mesh reference = creased_sheet();
    const auto stiff = fit(sheet_image(33), reference, {.strength = FitOptions::Strength::kStiff});
    const auto loose = fit(sheet_image(33), reference, {});
    ASSERT_TRUE(stiff.ok() && loose.ok());
    EXPECT_GT(decibels(loose.value().after.to_image, loose.value().before.to_image), 8);
    EXPECT_GT(decibels(loose.value().after.to_image, stiff.value().after.to_image), 3);
}

// Rows are squeezed together in pairs whose samples are exchanged: slivers that lie in the surface upside down.
TEST(Fit, SqueezedRowsThatCrossAreUnfolded) {
    const Mesh reference = bumpy_torus();
    SquareImage start = torus_on(reference, 65);
    for (uint32_t row = 5; row < 60; row += 4) {
        for (uint32_t column = 2; column < 63; ++column) {
            start.at(row, column) = 0.1 * start.at(row, column) + 0.9 * start.at(row - 1, column);
            if (column % 3 == 0) std::swap(start.at(row, column), start.at(row - 1, column));
        }
    }
    for (const auto strength : {FitOptions::Strength::kStiff, FitOptions::Strength::kLoose}) {
        const auto result = fit(start, reference, {.strength = strength});
        ASSERT_TRUE(result.ok());
        EXPECT_GT(result.value().before.folds, 300u);
        EXPECT_EQ(result.value().after.folds, 0u);
    }
}

TEST(Fit, AnImageThatCannotBeBetteredComesBackUnchanged) {
    const SquareImage start =
        image_of(17, open_sideband(), [](double u, double v) { return Vec3(0.1 * u, 0.1 * v, 0); });
    const Mesh square{{Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0.1, 0.1, 0), Vec3(0, 0.1, 0)}, {{0, 1, 2}, {0, 2, 3}}};
    const auto result = fit(start, square, {});
    ASSERT_TRUE(result.ok());
    if (!result.value().improved) {
        EXPECT_EQ(result.value().positions, start.positions);
    }
    EXPECT_LE(result.value().after.to_image, result.value().before.to_image);
    EXPECT_LE(result.value().after.to_reference, result.value().before.to_reference);
}

TEST(Fit, HeldSamplesDoNotMove) {
    const Mesh reference = bumpy_torus();
    const SquareImage start = torus_on(reference, 33);
    std::vector<bool> held(start.positions.size(), false);
    for (size_t v = 400; v < 500; ++v) held[v] = true;
    const auto result = fit(start, reference, {.held = held});
    ASSERT_TRUE(result.ok());
    ASSERT_TRUE(result.value().improved);
    size_t moved = 0;
    for (size_t v = 0; v < held.size(); ++v) {
        if (held[v]) {
            EXPECT_EQ(result.value().positions[v], start.positions[v]);
        }
        moved += result.value().positions[v] != start.positions[v] ? 1 : 0;
    }
    EXPECT_GT(moved, 800u);
}

// A bumpy sphere, and samples of a round one: the fit has to find the bumps.
Mesh bumpy_sphere() { return mesh_of(corpus::roughened(corpus::sphere(20), 0.01, 4)); }

TEST(Fit, ChartsComeNearerAndStayGlued) {
    const Mesh reference = bumpy_sphere();
    const MultiChartImage image = sphere_charts(33);
    const GridGluing& gluing = image.gluing;
    for (const auto strength : {FitOptions::Strength::kStiff, FitOptions::Strength::kLoose}) {
        const auto result = fit(image, reference, {.strength = strength});
        ASSERT_TRUE(result.ok()) << result.error().message;
        const Fitted& fitted = result.value();
        ASSERT_TRUE(fitted.improved);
        EXPECT_GT(decibels(fitted.after.to_image, fitted.before.to_image), 3);
        EXPECT_GT(decibels(fitted.after.to_reference, fitted.before.to_reference), 3);
        EXPECT_LE(fitted.after.folds, fitted.before.folds);
        size_t moved_on_seams = 0;
        for (uint32_t v = 0; v < gluing.sample_count(); ++v) {
            if (!gluing.is_defined(v)) {
                EXPECT_EQ(fitted.positions[v], image.positions[v]);
                continue;
            }
            EXPECT_EQ(fitted.positions[v], fitted.positions[gluing.representative[v]]);
            moved_on_seams += gluing.class_of[v] != kNone && fitted.positions[v] != image.positions[v];
        }
        EXPECT_GT(moved_on_seams, 200u);
    }
}

TEST(Fit, ChartsDoNotDependOnThreads) {
    const Mesh reference = bumpy_sphere();
    const MultiChartImage image = sphere_charts(33);
    const auto one = fit(image, reference, {.rounds = 4, .threads = 1}),
               two = fit(image, reference, {.rounds = 4, .threads = 2});
    ASSERT_TRUE(one.ok() && two.ok());
    EXPECT_TRUE(one.value().improved);
    EXPECT_EQ(one.value().positions, two.value().positions);
}

TEST(Fit, BordersOfChartsOnTheInputBoundaryStayThere) {
    const Mesh reference = creased_sheet();
    MultiChartImage image;
    image.mask = {40, 33, {}};
    const SquareImage sheet = sheet_image(33);
    for (uint32_t row = 0; row < 33; ++row) {
        for (uint32_t column = 0; column < 40; ++column) {
            image.mask.defined.push_back(column < 33);
            image.positions.push_back(column < 33 ? sheet.at(row, column) : Vec3(Vec3::Zero()));
        }
    }
    image.seams.loops = {{0, 1}};
    image.seams.paths = {{kNone, 128}};
    glue(image);
    const auto result = fit(image, reference, {});
    ASSERT_TRUE(result.ok());
    ASSERT_TRUE(result.value().improved);
    for (uint32_t k = 0; k < 33; ++k) {
        for (const uint32_t v : {k, k * 40 + 32, 32 * 40 + k, k * 40}) {
            const Vec3& p = result.value().positions[v];
            EXPECT_NEAR(std::max(std::abs(p[0]), std::abs(p[1])), 1, 1e-9);
        }
    }
}

TEST(Fit, ProgressRisesToOne) {
    const Mesh reference = bumpy_torus();
    std::vector<double> heard;
    (void)fit(torus_on(reference, 17), reference, {.rounds = 3}, [&](Stage stage, double fraction) {
        EXPECT_EQ(stage, Stage::kFit);
        heard.push_back(fraction);
        return true;
    });
    ASSERT_GE(heard.size(), 3u);
    EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
    EXPECT_EQ(heard.back(), 1.0);
}

TEST(Fit, UnusableInputIsRefused) {
    const Mesh reference = bumpy_torus();
    SquareImage image = torus_on(reference, 17);
    EXPECT_FALSE(fit(image, Mesh{}, {}).ok());
    EXPECT_FALSE(fit(image, reference, {.held = std::vector<bool>(5)}).ok());
    SquareImage short_image = image;
    short_image.positions.pop_back();
    EXPECT_FALSE(fit(short_image, reference, {}).ok());
    image.positions[20][1] = NAN;
    const auto result = fit(image, reference, {});
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().stage, Stage::kFit);
}

// The authors' image of the bunny, at half its resolution, with the gluing that its ring shows.
TEST(Fit, AuthorsImageOfTheBunnyGainsWhatThePrototypeGained) {
    const auto model = load_model("bunny.ply");
    std::ifstream file(std::string(GIM_MODELS_DIR) + "/../authors-gim/bunny-gim.gim", std::ios::binary);
    if (!model || !file) GTEST_SKIP() << "no development models in " << GIM_MODELS_DIR;
    constexpr uint32_t kFull = 257, kSide = 129;
    std::vector<float> planes(3 * kFull * kFull);
    file.read(reinterpret_cast<char*>(planes.data()), static_cast<std::streamsize>(planes.size() * sizeof(float)));

    Mesh reference = mesh_of(*model);
    for (Vec3& p : reference.positions) p = 3.545609 * p + Vec3(0.335758, 0.335798, 0.335768);
    SquareGrid grid{kSide, {}};
    for (uint32_t row = 0; row < kFull; row += 2) {
        for (uint32_t column = 0; column < kFull; column += 2) {
            const size_t v = row * kFull + column;
            grid.positions.emplace_back(planes[v], planes[v + kFull * kFull], planes[v + 2 * kFull * kFull]);
        }
    }
    const Sideband sideband = {
        129, 8, {{1, 92}, {0, 92}, {3, 72}, {2, 72}, {9, 10}, {6, 36}, {5, 36}, {8, 46}, {7, 46}, {4, 10}}};
    const SquareImage start = glue_square(std::move(grid), sideband).value();
    // The base of the bunny is open in the model and filled in the image.
    const ClosestPointTree tree(reference);
    const Topology topology = build_topology(reference);
    std::vector<bool> held(start.positions.size(), false);
    for (size_t v = 0; v < held.size(); ++v) {
        const ClosestPoint at = tree.find(start.positions[v]);
        for (uint32_t i = 0; i < 3; ++i) {
            if (at.barycentric[(i + 2) % 3] == 0 && topology.twin[3 * at.triangle + i] == kNone) held[v] = true;
        }
        if (std::sqrt(at.squared_distance) > 1e-3) held[v] = true;
    }
    const auto result = fit(start, reference, {.rounds = 8, .held = held});
    ASSERT_TRUE(result.ok()) << result.error().message;
    const Fitted& fitted = result.value();
    EXPECT_GT(decibels(fitted.after.to_image, fitted.before.to_image), 8);
    EXPECT_GT(decibels(fitted.after.to_reference, fitted.before.to_reference), 6);
    EXPECT_LE(fitted.after.folds, fitted.before.folds);
}

}  // namespace
}  // namespace gim
