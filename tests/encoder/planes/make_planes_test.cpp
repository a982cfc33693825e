// Attribute planes from mesh to decoded values.
#include "encoder/planes/make_planes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "corpus/generators.h"
#include "encoder/planes/input_colors.h"
#include "encoder/planes/sample_planes.h"
#include "encoder/squares/square_texels.h"
#include "encoder/surface/clean.h"
#include "gim/decoder.hpp"
#include "gim/encoder.h"

namespace gim {
namespace {

struct Decoded {
    uint32_t side = 0, plane_side = 0;
    std::vector<float> grid, values;

    // The bilinear position of the decoded image at a texel.
    Vec3 position(uint32_t row, uint32_t column) const {
        const double y = double(row) * (side - 1) / (plane_side - 1),
                     x = double(column) * (side - 1) / (plane_side - 1);
        const uint32_t r = std::min(static_cast<uint32_t>(y), side - 2),
                       c = std::min(static_cast<uint32_t>(x), side - 2);
        const auto at = [&](uint32_t i, uint32_t j) {
            const float* p = &grid[(size_t{i} * side + j) * 3];
            return Vec3(p[0], p[1], p[2]);
        };
        const double s = x - c, t = y - r;
        return (1 - t) * ((1 - s) * at(r, c) + s * at(r, c + 1)) + t * ((1 - s) * at(r + 1, c) + s * at(r + 1, c + 1));
    }
    Vec3 value(uint32_t row, uint32_t column) const {
        const float* v = &values[(size_t{row} * plane_side + column) * 3];
        return {v[0], v[1], v[2]};
    }
};

Decoded decode(const std::vector<uint8_t>& file, uint32_t kind) {
    Decoded d;
    Decoder decoder;
    DecoderLevel level;
    DecoderPlane plane;
    EXPECT_EQ(decoder.open(file), GIM_OK);
    EXPECT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    EXPECT_EQ(decoder.read_plane(0, kind, 0, &plane), GIM_OK);
    d.side = level.side;
    d.plane_side = plane.width;
    d.grid.resize(size_t{level.side} * level.side * 3);
    d.values.resize(size_t{plane.width} * plane.height * 3);
    EXPECT_EQ(decoder.grid(level, {d.grid, {}, {}, {}}), GIM_OK);
    EXPECT_EQ(decoder.plane(plane, d.values), GIM_OK);
    return d;
}

EncodeOptions small_options() {
    EncodeOptions options;
    options.side = 33;
    options.density = false;
    options.fit = FitStrength::kStiff;
    options.rate = {RateTarget::Kind::kQuality, 85};
    return options;
}

double mean_angle_to_sphere(const Decoded& d) {
    double sum = 0;
    for (uint32_t r = 0; r < d.plane_side; ++r) {
        for (uint32_t c = 0; c < d.plane_side; ++c)
            sum += std::acos(std::clamp(d.value(r, c).dot(d.position(r, c).normalized()), -1.0, 1.0));
    }
    return sum / (double(d.plane_side) * d.plane_side) * 180 / std::numbers::pi;
}

TEST(MakePlanes, NormalMapOfASphereIsWithinADegreeOfItsNormals) {
    EncodeOptions options = small_options();
    options.normal_side = 129;
    const auto encoded = encode(corpus::sphere(24), options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_LT(mean_angle_to_sphere(decode(encoded.value().bytes, GIM_PLANE_NORMALS)), 1.0);
    ASSERT_EQ(encoded.value().report.planes.size(), 1u);
    const PlaneReport& report = encoded.value().report.planes[0];
    EXPECT_EQ(report.width, 129u);
    EXPECT_GT(report.bytes, 0u);
    EXPECT_LT(report.mean_angle, 1.0);
}

// Red by x, green by y, blue by z, over -1 .. 1.
std::array<float, 3> color_of(const std::array<double, 3>& p) {
    const auto level = [](double x) { return static_cast<float>(0.5 + 0.45 * std::clamp(x, -1.0, 1.0)); };
    return {level(p[0]), level(p[1]), level(p[2])};
}

TriangleMesh colored_sphere() {
    TriangleMesh mesh = corpus::sphere(16);
    for (const auto& t : mesh.triangles) {
        mesh.appearance.corner_colors.push_back(
            {color_of(mesh.positions[t[0]]), color_of(mesh.positions[t[1]]), color_of(mesh.positions[t[2]])});
    }
    return mesh;
}

TEST(MakePlanes, VertexColorsComeBack) {
    const auto encoded = encode(colored_sphere(), small_options());
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    ASSERT_EQ(encoded.value().report.planes.size(), 1u);
    EXPECT_GT(encoded.value().report.planes[0].psnr, 40);
    const Decoded d = decode(encoded.value().bytes, GIM_PLANE_COLORS);
    double sum = 0;
    for (uint32_t r = 0; r < d.plane_side; ++r) {
        for (uint32_t c = 0; c < d.plane_side; ++c) {
            const Vec3 p = d.position(r, c).normalized();
            const std::array<float, 3> color = color_of({p.x(), p.y(), p.z()});
            sum += (d.value(r, c) - Vec3(color[0], color[1], color[2])).squaredNorm() / 3;
        }
    }
    EXPECT_GT(-10 * std::log10(sum / (double(d.plane_side) * d.plane_side)), 38);
}

// A texture over the sphere by latitude and longitude, which has a seam.
TriangleMesh textured_sphere() {
    TriangleMesh mesh = corpus::sphere(16);
    TextureImage image{64, 32, {}};
    for (uint32_t y = 0; y < image.height; ++y) {
        for (uint32_t x = 0; x < image.width; ++x) {
            const double around = (x + 0.5) / image.width * 2 * std::numbers::pi;
            image.rgb.push_back(static_cast<uint8_t>(128 + 100 * std::cos(around)));
            image.rgb.push_back(static_cast<uint8_t>(128 + 100 * std::sin(around)));
            image.rgb.push_back(static_cast<uint8_t>(8 * y));
        }
    }
    mesh.appearance.textures.push_back(image);
    for (const auto& t : mesh.triangles) {
        std::array<std::array<float, 2>, 3> uv;
        for (size_t k = 0; k < 3; ++k) {
            const auto& p = mesh.positions[t[k]];
            const double around = std::atan2(p[1], p[0]) / (2 * std::numbers::pi);
            uv[k] = {static_cast<float>(around),
                     static_cast<float>(std::acos(std::clamp(p[2], -1.0, 1.0)) / std::numbers::pi)};
        }
        for (size_t k = 1; k < 3; ++k) uv[k][0] -= std::round(uv[k][0] - uv[0][0]);  // not the long way round
        mesh.appearance.corner_texcoords.push_back(uv);
        mesh.appearance.triangle_texture.push_back(0);
    }
    return mesh;
}

TEST(MakePlanes, TexturesAreResampled) {
    EncodeOptions options = small_options();
    options.color_side = 129;
    const auto encoded = encode(textured_sphere(), options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    ASSERT_EQ(encoded.value().report.planes.size(), 1u);
    EXPECT_EQ(encoded.value().report.planes[0].width, 129u);
    EXPECT_GT(encoded.value().report.planes[0].psnr, 30);
}

// The fit to the quantizer slides samples along the surface. Colours must not slide with them.
TEST(MakePlanes, AFitToTheQuantizerLeavesColorsAtTheirPlaces) {
    TriangleMesh mesh = textured_sphere();
    TextureImage& image = mesh.appearance.textures[0];
    for (uint32_t y = 0; y < image.height; ++y) {
        for (uint32_t x = 0; x < image.width; ++x)
            for (size_t k = 0; k < 3; ++k)
                image.rgb[3 * (size_t{y} * image.width + x) + k] = (x / 4 + y / 4) % 2 ? 220 : 30;
    }
    for (const Layout layout : {Layout::kGim, Layout::kTiles}) {
        EncodeOptions options = small_options();
        options.layout = layout;
        options.tiles = 20;
        options.samples = 2000;
        options.color_side = 257;
        options.rate = {RateTarget::Kind::kQuality, 50};
        options.plane_quality = 85;
        const auto stiff = encode(mesh, options);
        options.fit = FitStrength::kAuto;
        const auto fitted = encode(mesh, options);
        ASSERT_TRUE(stiff.ok() && fitted.ok());
        EXPECT_GT(fitted.value().report.planes[0].psnr, stiff.value().report.planes[0].psnr - 2);
    }
}

TEST(MakePlanes, ColorsCanBeTurnedOff) {
    EncodeOptions options = small_options();
    options.color_side = 0;
    const auto encoded = encode(colored_sphere(), options);
    ASSERT_TRUE(encoded.ok());
    TriangleMesh plain = colored_sphere();
    plain.appearance = {};
    const auto without = encode(plain, small_options());
    ASSERT_TRUE(without.ok());
    EXPECT_EQ(encoded.value().bytes, without.value().bytes);
    EXPECT_TRUE(encoded.value().report.planes.empty());
}

TEST(MakePlanes, SameBytesAtAnyThreadCount) {
    EncodeOptions options = small_options();
    options.normal_side = 65;
    options.threads = 1;
    const auto one = encode(colored_sphere(), options);
    options.threads = 3;
    const auto three = encode(colored_sphere(), options);
    ASSERT_TRUE(one.ok() && three.ok());
    EXPECT_EQ(one.value().bytes, three.value().bytes);
}

TEST(MakePlanes, AByteBudgetHoldsWithPlanes) {
    EncodeOptions options = small_options();
    options.normal_side = 257;
    options.rate = {RateTarget::Kind::kBytes, 3000};
    const auto encoded = encode(colored_sphere(), options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_LE(encoded.value().bytes.size(), 3000u);
    EXPECT_EQ(encoded.value().report.planes.size(), 2u);
}

TEST(MakePlanes, InconsistentColorsAreRefused) {
    TriangleMesh mesh = colored_sphere();
    mesh.appearance.corner_colors.pop_back();
    EXPECT_FALSE(encode(mesh, small_options()).ok());
    mesh = textured_sphere();
    mesh.appearance.triangle_texture[7] = 1;
    EXPECT_FALSE(encode(mesh, small_options()).ok());
    mesh = textured_sphere();
    mesh.appearance.textures[0].rgb.pop_back();
    EXPECT_FALSE(encode(mesh, small_options()).ok());
}

// ---- parts ----------------------------------------------------------------------------------------------------------

Mesh cleaned(const TriangleMesh& mesh) {
    auto result = clean(mesh);
    EXPECT_TRUE(result.ok());
    return result.value().mesh;
}

TEST(SamplePlanes, NormalsAreSharpOverCreasesAndSmoothElsewhere) {
    const Mesh box = cleaned(corpus::box(6, 1, 1));
    const AttributeSource source(box);
    for (uint32_t f = 0; f < box.triangles.size(); ++f) {
        const Triangle& t = box.triangles[f];
        const Vec3 n = (box.positions[t[1]] - box.positions[t[0]]).cross(box.positions[t[2]] - box.positions[t[0]]);
        ClosestPoint at;
        at.triangle = f;
        at.barycentric = {0.9, 0.05, 0.05};
        EXPECT_GT(source.normal(at).dot(n.normalized()), 0.9999) << f;
    }
    const Mesh sphere = cleaned(corpus::sphere(12));
    const AttributeSource round(sphere);
    for (uint32_t f = 0; f < sphere.triangles.size(); ++f) {
        ClosestPoint at;
        at.triangle = f;
        at.barycentric = {1, 0, 0};
        EXPECT_GT(round.normal(at).dot(sphere.positions[sphere.triangles[f][0]].normalized()), 0.999) << f;
    }
}

TEST(SamplePlanes, AThinSheetDoesNotShowItsOtherSide) {
    // A flat open image just below the upper side of a thin plate, so that the lower side is nearer.
    const Mesh plate = cleaned(corpus::box(4, 0.01, 1));
    double top = -1e9, bottom = 1e9, left = 1e9, right = -1e9, near = 1e9, far = -1e9;
    for (const Vec3& p : plate.positions) {
        top = std::max(top, p.y()), bottom = std::min(bottom, p.y());
        left = std::min(left, p.x()), right = std::max(right, p.x());
        near = std::min(near, p.z()), far = std::max(far, p.z());
    }
    SquareGrid grid{5, {}};
    for (uint32_t r = 0; r < 5; ++r) {
        for (uint32_t c = 0; c < 5; ++c) {
            // d/dcolumn = z, d/drow = x: z cross x = y, outwards at the top.
            grid.positions.emplace_back(left + (right - left) * (0.2 + 0.15 * r), bottom + 0.4 * (top - bottom),
                                        near + (far - near) * (0.2 + 0.15 * c));
        }
    }
    const AttributeSource source(plate);
    const SquareImage image = glue_square(std::move(grid), {}).value();
    for (const ClosestPoint& p : source.locate(square_texels(image, 17).texels)) EXPECT_NEAR(p.point.y(), top, 1e-12);
}

TEST(InputColors, TexturesRepeatAndCornersMultiply) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.appearance.textures = {{2, 1, {255, 0, 0, 0, 255, 0}}};
    mesh.appearance.triangle_texture = {0};
    mesh.appearance.corner_texcoords = {{{{1.25f, 0.5f}, {1.25f, 0.5f}, {1.25f, 0.5f}}}};
    const std::vector<Vec3> points = {Vec3(0.2, 0.2, 0)};
    EXPECT_EQ(InputColors(mesh).at(points), (std::vector<float>{255, 0, 0}));
    mesh.appearance.corner_texcoords = {{{{-0.25f, 0.5f}, {-0.25f, 0.5f}, {-0.25f, 0.5f}}}};
    EXPECT_EQ(InputColors(mesh).at(points), (std::vector<float>{0, 255, 0}));
    const std::array<float, 3> dark = {1, 0, 1};
    mesh.appearance.corner_colors = {{dark, dark, dark}};
    EXPECT_EQ(InputColors(mesh).at(points), (std::vector<float>{0, 0, 0}));
    mesh.appearance.triangle_texture = {UINT32_MAX};
    EXPECT_EQ(InputColors(mesh).at(points), (std::vector<float>{255, 0, 255}));
}

}  // namespace
}  // namespace gim
