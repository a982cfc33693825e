#include "encoder/surface/local_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "corpus/generators.h"
#include "encoder/code/decode_surface.h"
#include "gim/encoder.h"

namespace gim {
namespace {

TriangleMesh placed(TriangleMesh mesh, double scale, const std::array<double, 3>& origin) {
    for (auto& p : mesh.positions) {
        for (size_t k = 0; k < 3; ++k) p[k] = origin[k] + scale * p[k];
    }
    return mesh;
}

std::vector<Vec3> points_of(const TriangleMesh& mesh) {
    std::vector<Vec3> points;
    for (const auto& p : mesh.positions) points.emplace_back(p[0], p[1], p[2]);
    return points;
}

EncodeOptions small_options(Layout layout = Layout::kGim) {
    EncodeOptions options;
    options.layout = layout;
    options.side = 33;
    options.samples = 2000;
    options.threads = 1;
    return options;
}

constexpr std::array<double, 3> kUtm = {500000.3, 4000000.7, 251.1};

TEST(LocalFrame, OrdinaryPlacesKeepObjectSpace) {
    const TriangleMesh ball = corpus::sphere(8);
    for (const uint32_t bits : {8u, 12u, 16u, 20u}) {
        for (const double scale : {1e-20, 1.0, 1e20}) {
            for (const double distance : {0.0, 0.5, 5.0, 12.0}) {
                const auto points = points_of(placed(ball, scale, {distance * scale, 0, -distance * scale}));
                EXPECT_FALSE(choose_frame(points, bits).is_moved) << bits << " " << scale << " " << distance;
            }
        }
    }
    EXPECT_FALSE(choose_frame(points_of(placed(ball, 1, {60, 0, 0})), 12).is_moved);
    EXPECT_TRUE(choose_frame(points_of(placed(ball, 1, {300, 0, 0})), 12).is_moved);
    EXPECT_TRUE(choose_frame(points_of(placed(ball, 1, kUtm)), 12).is_moved);
    EXPECT_TRUE(choose_frame(points_of(placed(ball, 1e-9, {0, 1, 0})), 12).is_moved);
    EXPECT_FALSE(choose_frame(points_of(placed(ball, 0, {1e9, 2, 3})), 12).is_moved);  // one place has no extent
    EXPECT_FALSE(choose_frame({}, 12).is_moved);
    // A flat sheet far away, but not many of its extents.
    TriangleMesh sheet = corpus::terrain(4);
    for (auto& p : sheet.positions) p = {1e6 * p[0], 1e6 * p[1], 1e6 + p[2]};
    EXPECT_FALSE(choose_frame(points_of(sheet), 12).is_moved);
}

TEST(LocalFrame, WhatTheFormatCannotHoldIsRefusedByTheNameOfAVertex) {
    const TriangleMesh ball = corpus::sphere(8);
    const auto refused = [](const TriangleMesh& mesh, const char* why) {
        const auto checked = check_extent(mesh, 12);
        ASSERT_FALSE(checked.ok()) << why;
        EXPECT_NE(checked.error().message.find("vertex "), std::string::npos) << checked.error().message;
        EXPECT_NE(checked.error().message.find(why), std::string::npos) << checked.error().message;
        EXPECT_FALSE(encode(mesh, small_options()).ok());
    };
    for (const double scale : {1e30, 1e60, 1e200, 1e308}) refused(placed(ball, scale, {}), "too large");
    for (const double scale : {1e-30, 1e-100, 1e-310, 5e-324}) refused(placed(ball, scale, {}), "too small");
    refused(placed(ball, 1e15, {1e31, 0, 0}), "too large");
    TriangleMesh spike = ball;
    spike.positions[7][1] = -1e60;
    const auto checked = check_extent(spike, 12);
    ASSERT_FALSE(checked.ok());
    EXPECT_NE(checked.error().message.find("vertex 7 at"), std::string::npos) << checked.error().message;
    EXPECT_NE(checked.error().message.find("-1e+60"), std::string::npos) << checked.error().message;
    refused(placed(ball, 0, {1, 2, 3}), "same place");
    refused(placed(ball, 1e-30, {1, 1, 1}), "same place");  // 1 + 1e-30 is 1
    // A vertex that no triangle uses does not count.
    TriangleMesh stray = ball;
    stray.positions.push_back({1e200, 0, 0});
    EXPECT_TRUE(check_extent(stray, 12).ok());
    // What is no number has its own message.
    spike.positions[7][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(check_extent(spike, 12).ok());
    EXPECT_NE(encode(spike, small_options()).error().message.find("finite"), std::string::npos);
}

TEST(LocalFrame, SurfacesFarFromZeroKeepTheirQuality) {
    const TriangleMesh ball = corpus::sphere(16);
    for (const Layout layout : {Layout::kGim, Layout::kMcgim}) {
        const EncodeOptions options = small_options(layout);
        const auto near = encode(ball, options);
        ASSERT_TRUE(near.ok()) << near.error().message;
        for (const auto& [scale, origin] :
             {std::pair{1.0, kUtm}, {0.25, {-1e9, 1e9, 0}}, {1e-9, {0, 1, 0}}, {1e20, {1e27, 0, 0}}}) {
            const TriangleMesh mesh = placed(ball, scale, origin);
            const auto far = encode(mesh, options);
            ASSERT_TRUE(far.ok()) << far.error().message;
            EXPECT_GT(far.value().report.error.psnr, near.value().report.error.psnr - 1);
            const gim_info info = read_own_info(far.value().bytes).value();
            EXPECT_EQ(info.is_relative, 1u);
            const Mesh decoded = decode_surface(far.value().bytes, 0).value();
            TriangleMesh test;
            for (const Vec3& p : decoded.positions) test.positions.push_back({p.x(), p.y(), p.z()});
            test.triangles = decoded.triangles;
            const auto compared = compare(mesh, test, {});
            ASSERT_TRUE(compared.ok());
            EXPECT_NEAR(compared.value().psnr, far.value().report.error.psnr, 0.2);
        }
        EXPECT_EQ(read_own_info(near.value().bytes).value().is_relative, 0u);
    }
}

TEST(LocalFrame, TargetsAndLosslessFilesWorkFarFromZero) {
    const TriangleMesh mesh = placed(corpus::sphere(16), 1, kUtm);
    EncodeOptions options = small_options();
    options.rate = {RateTarget::Kind::kPsnr, 62};
    const auto psnr = encode(mesh, options);
    ASSERT_TRUE(psnr.ok()) << psnr.error().message;
    EXPECT_GE(psnr.value().report.error.psnr, 62);
    options.rate = {RateTarget::Kind::kMaxError, 0.02};
    const auto error = encode(mesh, options);
    ASSERT_TRUE(error.ok()) << error.error().message;
    EXPECT_LE(error.value().report.error.hausdorff, 0.02);
    options.rate = {RateTarget::Kind::kBytes, 600};
    const auto bytes = encode(mesh, options);
    ASSERT_TRUE(bytes.ok()) << bytes.error().message;
    EXPECT_LE(bytes.value().bytes.size(), 600u);
    options.rate = {RateTarget::Kind::kLossless, 0};
    const auto lossless = encode(mesh, options);
    ASSERT_TRUE(lossless.ok()) << lossless.error().message;
    EXPECT_EQ(read_own_info(lossless.value().bytes).value().is_relative, 1u);
    EXPECT_GT(lossless.value().report.error.psnr, 60);
}

TEST(LocalFrame, PlanesAndStatesAreThoseOfTheSurfaceInItsPlace) {
    TriangleMesh mesh = placed(corpus::sphere(12), 1, kUtm);
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        const float red = f % 2 == 0 ? 0.25f : 0.75f;
        mesh.appearance.corner_colors.push_back({{{red, 0.5f, 1}, {red, 0.5f, 1}, {red, 0.5f, 1}}});
    }
    EncodeOptions options = small_options();
    options.normal_side = options.color_side.emplace(33);
    size_t states = 0;
    const auto encoded = encode(mesh, options, {}, [&](const Snapshot& state) {
        ++states;
        for (const auto& p : state.mesh.positions) EXPECT_NEAR(p[1], kUtm[1], 2) << state.name;
    });
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_GT(states, 0u);
    ASSERT_EQ(encoded.value().report.planes.size(), 2u);
    TriangleMesh near = mesh;
    for (auto& p : near.positions) {
        for (size_t k = 0; k < 3; ++k) p[k] -= kUtm[k];
    }
    const auto reference = encode(near, options);
    ASSERT_TRUE(reference.ok());
    EXPECT_NEAR(encoded.value().report.planes[0].mean_angle, reference.value().report.planes[0].mean_angle, 0.5);
    EXPECT_NEAR(encoded.value().report.planes[1].psnr, reference.value().report.planes[1].psnr, 1);
}

TEST(LocalFrame, GeometryImagesFarFromZeroKeepTheirFloats) {
    // Floats at 4,000,000 are multiples of 1/4.
    constexpr uint32_t kSide = 17;
    std::vector<float> channels(3 * size_t{kSide} * kSide);
    for (uint32_t i = 0; i < kSide * kSide; ++i) {
        const double u = i % kSide, v = i / kSide;
        channels[i] = static_cast<float>(500000 + u);
        channels[kSide * kSide + i] = static_cast<float>(4000000 + v);
        channels[2 * kSide * kSide + i] = static_cast<float>(std::sin(u / 4) + std::cos(v / 4));
    }
    EncodeOptions options = small_options();
    options.rate = {RateTarget::Kind::kLossless, 0};
    options.bits = 16;
    const auto encoded = encode_image(channels, kSide, 0, options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_EQ(read_own_info(encoded.value().bytes).value().is_relative, 1u);
    EXPECT_GT(encoded.value().report.error.psnr, 90);
    channels[5] = 1e35f;
    const auto refused = encode_image(channels, kSide, 0, options);
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("column 5"), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace gim
