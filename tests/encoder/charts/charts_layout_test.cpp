// The whole way in the multi-chart layout: mesh -> .gim -> mesh.
#include "encoder/charts/charts_layout.h"

#include <gtest/gtest.h>

#include "corpus/corpus.h"
#include "encoder/code/decode_surface.h"
#include "gim/decoder.h"

namespace gim {
namespace {

EncodeOptions chart_options(uint32_t samples = 6000) {
    EncodeOptions options;
    options.layout = Layout::kMcgim;
    options.samples = samples;
    options.charts = 6;
    options.rate = {RateTarget::Kind::kQuality, 60};
    options.fit = FitStrength::kOff;
    options.density = false;
    return options;
}

void expect_topology_at_every_level(const Encoded& encoded, const std::string& name) {
    const auto coarsest = coarsest_level(encoded.bytes);
    ASSERT_TRUE(coarsest.ok()) << name;
    for (uint32_t level = 0; level <= coarsest.value(); ++level) {
        const auto mesh = decode_surface(encoded.bytes, level);
        ASSERT_TRUE(mesh.ok()) << name << ": " << mesh.error().message;
        const TopologySummary t = analyse_topology(mesh.value().triangles, mesh.value().positions.size()).summary;
        EXPECT_TRUE(same_topology(t, encoded.report.topology)) << name << " level " << level;
        ASSERT_LT(level, encoded.report.levels.size());
        EXPECT_EQ(t.vertices, encoded.report.levels[level].vertices) << name;
        EXPECT_EQ(t.triangles, encoded.report.levels[level].triangles) << name;
    }
}

TEST(EncodeCharts, SurfacesOfEveryKindComeBackWithTheirTopologyAtEveryLevel) {
    EncodeOptions options = chart_options(4000);
    for (const char* name : {"sphere-108", "torus-576", "tori-2", "disk-180", "annulus-512", "four-pieces"}) {
        const bool lossless = options.rate.kind == RateTarget::Kind::kLossless;
        options.rate = {lossless ? RateTarget::Kind::kQuality : RateTarget::Kind::kLossless, 50};
        const auto encoded = encode(corpus::corpus().named(name).mesh(), options);
        ASSERT_TRUE(encoded.ok()) << name << ": " << encoded.error().message;
        EXPECT_GT(encoded.value().report.error.psnr, 40) << name;
        expect_topology_at_every_level(encoded.value(), name);
    }
}

TEST(EncodeCharts, TheReportDescribesTheFile) {
    const auto encoded = encode(corpus::corpus().named("torus-576").mesh(), chart_options());
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    const EncodeReport& report = encoded.value().report;
    const std::vector<uint8_t>& bytes = encoded.value().bytes;
    gim_info info;
    ASSERT_EQ(gim_read_info(bytes.data(), bytes.size(), nullptr, &info), GIM_OK);
    EXPECT_EQ(info.layout, static_cast<uint32_t>(GIM_LAYOUT_MCGIM));
    EXPECT_EQ(report.layout, Layout::kMcgim);
    EXPECT_EQ(report.images, 1u);
    EXPECT_EQ(report.samples, info.sample_count);
    EXPECT_EQ(report.samples, uint64_t{report.width} * report.height);
    EXPECT_LE(report.samples, 6000u);
    EXPECT_GE(report.charts, 6u);
    EXPECT_GT(report.defined_samples, report.samples / 3);
    EXPECT_LT(report.defined_samples, report.samples);
    EXPECT_EQ(report.packing_efficiency, double(report.defined_samples) / double(report.samples));
    EXPECT_GT(report.stretch_efficiency, 0.3);
    EXPECT_LE(report.stretch_efficiency, 1);
    EXPECT_EQ(report.file_bytes, bytes.size());
    uint32_t paths = 0;
    ASSERT_EQ(gim_read_seams(&info, bytes.data(), bytes.size(), 0, 0, nullptr, &paths), GIM_OK);
    EXPECT_EQ(report.cut_paths, paths);
    ASSERT_EQ(report.levels.size(), info.level_count);
    ASSERT_GE(report.levels.size(), 2u);
    for (uint32_t level = 0; level < info.level_count; ++level) {
        gim_level_info shape;
        ASSERT_EQ(gim_read_level_info(&info, bytes.data(), bytes.size(), 0, level, &shape), GIM_OK);
        EXPECT_EQ(report.levels[level].width, shape.width);
        EXPECT_EQ(report.levels[level].height, shape.height);
        EXPECT_EQ(report.levels[level].prefix_bytes, shape.prefix_size);
        EXPECT_GE(info.level_rms_error[level], report.levels[level].rms_error);
        EXPECT_GE(info.level_max_error[level], report.levels[level].max_error);
        if (level > 0) {
            EXPECT_LT(report.levels[level].psnr, report.levels[level - 1].psnr);
        }
    }
}

TEST(EncodeCharts, SameBytesAtAnyThreadCountAndInEveryRun) {
    EncodeOptions options = chart_options(2500);
    options.fit = FitStrength::kLoose;
    const TriangleMesh mesh = corpus::corpus().named("torus-576").mesh();
    options.threads = 1;
    const auto one = encode(mesh, options), again = encode(mesh, options);
    options.threads = 3;
    const auto three = encode(mesh, options);
    ASSERT_TRUE(one.ok() && again.ok() && three.ok());
    EXPECT_EQ(one.value().bytes, again.value().bytes);
    EXPECT_EQ(one.value().bytes, three.value().bytes);
}

TEST(EncodeCharts, RateTargetsAreMet) {
    const TriangleMesh mesh = corpus::corpus().named("torus-576").mesh();
    EncodeOptions options = chart_options(2500);
    options.rate = {RateTarget::Kind::kPsnr, 38};
    const auto psnr = encode(mesh, options);
    ASSERT_TRUE(psnr.ok()) << psnr.error().message;
    EXPECT_GE(psnr.value().report.error.psnr, 38);
    EXPECT_LE(psnr.value().report.error.psnr, 38.5);
    options.rate = {RateTarget::Kind::kBytes, 1800};
    const auto bytes = encode(mesh, options);
    ASSERT_TRUE(bytes.ok()) << bytes.error().message;
    EXPECT_LE(bytes.value().bytes.size(), 1800u);
    EXPECT_GE(bytes.value().bytes.size(), 1700u);
}

TEST(EncodeCharts, AFitToTheCodecTakesFewerBytesForAnEqualError) {
    const TriangleMesh mesh = corpus::corpus().named("tori-2").mesh();
    EncodeOptions options = chart_options(6000);
    options.rate = {RateTarget::Kind::kPsnr, 45};
    options.fit = FitStrength::kStiff;
    const auto plain = encode(mesh, options);
    options.fit = FitStrength::kAuto;
    const auto fitted = encode(mesh, options);
    ASSERT_TRUE(plain.ok() && fitted.ok());
    EXPECT_LT(double(fitted.value().bytes.size()), 0.8 * double(plain.value().bytes.size()));
    expect_topology_at_every_level(fitted.value(), "fitted");
}

TEST(EncodeCharts, FewerSamplesAreTriedForATarget) {
    const TriangleMesh mesh = corpus::corpus().named("tori-2").mesh();
    EncodeOptions options = chart_options(20000);
    options.rate = {RateTarget::Kind::kPsnr, 42};
    const auto whole = encode(mesh, options);
    options.try_smaller_sides = true;
    const auto best = encode(mesh, options);
    ASSERT_TRUE(whole.ok() && best.ok());
    EXPECT_GE(best.value().report.error.psnr, 42);
    EXPECT_LT(best.value().report.samples, 10001u);
    EXPECT_LT(best.value().bytes.size(), whole.value().bytes.size());
}

TEST(EncodeCharts, TooFewSamplesAreRefusedWithWords) {
    const auto encoded = encode(corpus::corpus().named("plate-5").mesh(), chart_options(60));
    ASSERT_FALSE(encoded.ok());
    EXPECT_NE(encoded.error().message.find("samples"), std::string::npos) << encoded.error().message;
}

TEST(EncodeCharts, AFitBringsTheSurfaceNearer) {
    const TriangleMesh mesh = corpus::corpus().named("tori-2").mesh();
    EncodeOptions options = chart_options(4000);
    options.rate = {RateTarget::Kind::kLossless, 0};  // with so few samples, quantizers would hide it
    const auto plain = encode(mesh, options);
    options.fit = FitStrength::kLoose;
    const auto fitted = encode(mesh, options);
    ASSERT_TRUE(plain.ok() && fitted.ok());
    EXPECT_GT(fitted.value().report.error.psnr, plain.value().report.error.psnr);
    expect_topology_at_every_level(fitted.value(), "fitted");
}

}  // namespace
}  // namespace gim
