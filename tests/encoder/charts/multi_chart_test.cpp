#include "encoder/charts/multi_chart.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "encoder/surface/compare_meshes.h"
#include "encoder/surface/topology_summary.h"
#include "tests/encoder/stage_meshes.h"
#include "tests/models.h"

namespace gim {
namespace {

TopologySummary topology_of(const Mesh& mesh) {
    return analyse_topology(mesh.triangles, mesh.positions.size()).summary;
}

Result<MultiChart> image_of(const Mesh& mesh, uint32_t charts, uint32_t samples, uint32_t threads = 0,
                            std::optional<FitOptions::Strength> strength = {}) {
    StageClock clock({});
    MultiChartOptions options;
    options.charts = charts;
    options.samples = samples;
    options.pack_effort = 2;
    options.threads = threads;
    options.fit = strength;
    return make_multi_chart_image(mesh, options, clock);
}

void expect_same_topology(const Mesh& mesh, const MultiChartImage& image, const std::string& name) {
    const TopologySummary wanted = topology_of(mesh), found = topology_of(surface_of(image).mesh);
    EXPECT_TRUE(found.manifold) << name;
    EXPECT_EQ(found.components, wanted.components) << name;
    EXPECT_EQ(found.boundary_loops, wanted.boundary_loops) << name;
    EXPECT_EQ(found.genus, wanted.genus) << name;
}

Mesh surface_named(const std::string& name) {
    std::vector<NamedMesh> all = surfaces();
    for (NamedMesh& m : all) {
        if (m.name == name) return std::move(m.mesh);
    }
    ADD_FAILURE() << "no mesh " << name << " in the corpus";
    return {};
}

void expect_glued_samples_are_equal(const MultiChartImage& image, const std::string& name) {
    const auto point = glue_samples(image.mask, image.seams);
    ASSERT_TRUE(point.ok()) << name;
    size_t glued = 0;
    for (size_t i = 0; i < image.positions.size(); ++i) {
        if (point.value()[i] == kNone) continue;
        ASSERT_EQ(image.positions[i], image.positions[point.value()[i]]) << name;
        glued += point.value()[i] != i;
    }
    EXPECT_GT(glued, 0u) << name;
}

TEST(MultiChart, EverySurfaceComesBackWithItsTopologyAndShape) {
    for (const NamedMesh& m : surfaces()) {
        constexpr uint32_t kSamples = 15000;
        const auto made = image_of(m.mesh, 8, kSamples);
        ASSERT_TRUE(made.ok()) << m.name << ": " << made.error().message;
        const MultiChartImage& image = made.value().image;
        EXPECT_LE(uint64_t{image.width()} * image.height(), kSamples) << m.name;
        expect_same_topology(m.mesh, image, m.name);
        expect_glued_samples_are_equal(image, m.name);
        const auto compared = ReferenceSurface(m.mesh).compare(surface_of(image).mesh, {.samples = 20000});
        ASSERT_TRUE(compared.ok()) << m.name;
        EXPECT_GT(compared.value().psnr, 50) << m.name;
    }
}

// A tube that is much longer than wide has no three samples around it unless its axes are made even.
TEST(MultiChart, EvenAxesMakeChartsOfALongTube) {
    Mesh mesh = surface_named("torus-576");
    for (Vec3& p : mesh.positions) p.x() *= 300;
    StageClock clock({});
    MultiChartOptions options;
    options.samples = 10000;
    options.pack_effort = 2;
    options.most_packings = 2;
    options.fit = {};
    EXPECT_FALSE(make_multi_chart_image(mesh, options, clock).ok());
    options.even_axes = true;
    const auto made = make_multi_chart_image(mesh, options, clock);
    ASSERT_TRUE(made.ok()) << made.error().message;
    expect_same_topology(mesh, made.value().image, "long torus");
    expect_glued_samples_are_equal(made.value().image, "long torus");
    const auto compared = ReferenceSurface(mesh).compare(surface_of(made.value().image).mesh, {.samples = 20000});
    ASSERT_TRUE(compared.ok());
    EXPECT_GT(compared.value().psnr, 50);
}

// Sander et al. 2001, section 3, by singular values: the least possible mean square of them over the mean square.
double measured_efficiency(const MultiChart& made) {
    double squared = 0, surface = 0, domain = 0;
    for (size_t c = 0; c < made.atlas.charts.size(); ++c) {
        const Mesh& mesh = made.atlas.charts[c].mesh;
        const std::vector<Vec2>& uv = made.atlas.maps[c].uv;
        for (const Triangle& t : mesh.triangles) {
            Eigen::Matrix2d flat;
            flat << uv[t[1]] - uv[t[0]], uv[t[2]] - uv[t[0]];
            Eigen::Matrix<double, 3, 2> edges;
            edges << mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]];
            const double area = 0.5 * edges.col(0).cross(edges.col(1)).norm();
            if (area == 0) continue;
            squared += area * (edges * flat.inverse()).squaredNorm() / 2;
            surface += area;
            domain += flat.determinant() / 2;
        }
    }
    return surface * surface / (domain * squared);
}

TEST(MultiChart, StretchEfficiencyIsThatOfTheMapsThatAreSampled) {
    const Mesh mesh = surface_named("limbs");
    for (const bool has_density : {false, true}) {
        for (const bool even_axes : {false, true}) {
            StageClock clock({});
            MultiChartOptions options;
            options.samples = 15000;
            options.pack_effort = 2;
            options.density = has_density;
            options.even_axes = even_axes;
            options.fit = {};
            const auto made = make_multi_chart_image(mesh, options, clock);
            ASSERT_TRUE(made.ok()) << made.error().message;
            EXPECT_NEAR(made.value().stretch_efficiency, measured_efficiency(made.value()), 1e-6);
            EXPECT_LE(made.value().stretch_efficiency, 1);
            EXPECT_GT(made.value().stretch_efficiency, has_density || even_axes ? 0.3 : 0.85);
        }
    }
}

TEST(MultiChart, FewSamplesDoNotBreakTheSurface) {
    for (const NamedMesh& m : surfaces()) {
        const auto made = image_of(m.mesh, 6, 5000);
        ASSERT_TRUE(made.ok()) << m.name << ": " << made.error().message;
        expect_same_topology(m.mesh, made.value().image, m.name);
    }
}

TEST(MultiChart, ImageDoesNotDependOnThreads) {
    const Mesh mesh = surface_named("tori-2");
    const auto one = image_of(mesh, 8, 8000, 1), three = image_of(mesh, 8, 8000, 3);
    ASSERT_TRUE(one.ok() && three.ok());
    EXPECT_EQ(one.value().image.mask.defined, three.value().image.mask.defined);
    EXPECT_EQ(one.value().image.positions, three.value().image.positions);
}

TEST(MultiChart, FitBringsTheImageNearerAndKeepsTheSurface) {
    for (const char* name : {"tori-2", "terrain-3200"}) {
        const Mesh mesh = surface_named(name);
        for (const auto strength : {FitOptions::Strength::kStiff, FitOptions::Strength::kLoose}) {
            const auto sampled = image_of(mesh, 8, 8000), fitted = image_of(mesh, 8, 8000, 0, strength);
            ASSERT_TRUE(sampled.ok() && fitted.ok()) << name;
            const MultiChart& chart = fitted.value();
            EXPECT_EQ(chart.image.mask.defined, sampled.value().image.mask.defined) << name;
            EXPECT_NE(chart.image.positions, sampled.value().image.positions) << name;
            EXPECT_LT(chart.after_fit.to_image, chart.before_fit.to_image) << name;
            EXPECT_LT(chart.after_fit.to_reference, chart.before_fit.to_reference) << name;
            EXPECT_LE(chart.after_fit.folds, chart.before_fit.folds) << name;
            expect_same_topology(mesh, chart.image, name);
            expect_glued_samples_are_equal(chart.image, name);
        }
    }
}

TEST(MultiChart, AutomaticChartsFollowCreasesAndSamples) {
    const Mesh smooth = surface_named("tori-2"), creased = surface_named("plate-5");
    EXPECT_GT(automatic_charts(creased, 65536), automatic_charts(smooth, 65536));
    EXPECT_GT(automatic_charts(smooth, 65536), automatic_charts(smooth, 10000));
    EXPECT_GE(automatic_charts(smooth, 100), 6u);
    Mesh larger = creased;
    for (Vec3& p : larger.positions) p *= 1000;
    EXPECT_EQ(automatic_charts(larger, 65536), automatic_charts(creased, 65536));
    const auto made = image_of(smooth, 0, 8000);
    ASSERT_TRUE(made.ok());
    EXPECT_GE(made.value().atlas.charts.size(), 4u);
}

TEST(MultiChart, TooFewSamplesAreRefused) { EXPECT_FALSE(image_of(surface_named("plate-5"), 8, 60).ok()); }

TEST(MultiChart, ModelsOfEveryKindComeBackWithTheirTopology) {
    for (const char* name : {"teapot.ply", "bones.ply", "mask-holes.ply", "laurana.ply", "three-torus.ply"}) {
        const auto model = load_model(name);
        if (!model) GTEST_SKIP() << "no development models";
        const auto cleaned = clean(*model, {.require_connected = false});
        ASSERT_TRUE(cleaned.ok()) << name;
        const auto image = image_of(cleaned.value().mesh, 20, 65536);
        ASSERT_TRUE(image.ok()) << name << ": " << image.error().message;
        expect_same_topology(cleaned.value().mesh, image.value().image, name);
    }
}

}  // namespace
}  // namespace gim
