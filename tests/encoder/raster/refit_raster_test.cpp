#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "corpus/corpus.h"
#include "encoder/code/decode_surface.h"
#include "encoder/fit/fitter.h"
#include "encoder/surface/closest_point.h"
#include "gim/decoder.hpp"
#include "gim/refit.h"
#include "tests/encoder/raster/made_rasters.h"

namespace gim {
namespace {

using namespace gim::test;
using Point = std::array<double, 3>;

constexpr uint32_t kSide = 13;  // samples of a piece

// Moves a point of the unit sphere to a potato.
Point bumpy(const Point& p) {
    const double r = 10 * (1 + 0.12 * std::sin(4 * p[0]) * std::cos(3 * p[1] + 1) + 0.05 * std::sin(9 * p[2] + p[0]));
    return {r * p[0], r * p[1], r * p[2]};
}

TriangleMesh potato() {
    TriangleMesh mesh = corpus::sphere(40);
    for (Point& p : mesh.positions) {
        const double length = std::hypot(p[0], p[1], p[2]);
        p = bumpy({p[0] / length, p[1] / length, p[2] / length});
    }
    return mesh;
}

// The sides of a cube around the potato, one beside the other, with a free column in between. Borders coincide.
RasterImage potato_image(uint32_t pieces = 6, uint32_t side = kSide) {
    RasterImage image;
    image.width = pieces * (side + 1) - 1;
    image.height = side;
    image.type = SampleType::kFloat64;
    image.mask = RasterImage::Mask::kArray;
    for (uint32_t row = 0; row < side; ++row) {
        for (uint32_t column = 0; column < image.width; ++column) {
            const uint32_t piece = column / (side + 1), at = column % (side + 1);
            image.defined.push_back(at < side ? 1 : 0);
            const double u = 2.0 * at / (side - 1) - 1, v = 2.0 * row / (side - 1) - 1;
            const double s = piece % 2 == 0 ? 1 : -1;
            Point p = {s, s * u, v};
            for (uint32_t k = 0; k < piece / 2; ++k) p = {p[2], p[0], p[1]};
            const double length = std::hypot(p[0], p[1], p[2]);
            const Point place = bumpy({p[0] / length, p[1] / length, p[2] / length});
            for (const double x : place) image.values.push_back(at < side ? x : 0);
        }
    }
    return image;
}

EncodeOptions options_of(RateTarget rate, uint32_t bits = 14) {
    EncodeOptions options;
    options.rate = rate;
    options.bits = bits;
    options.threads = 1;
    return options;
}
const EncodeOptions kExact = options_of({RateTarget::Kind::kLossless, 0});

Encoded refitted(const RasterImage& image, const TriangleMesh& mesh, const EncodeOptions& options = kExact) {
    Result<Encoded> file = refit_raster(image, mesh, options);
    EXPECT_TRUE(file.ok()) << file.error().message;
    return file.ok() ? std::move(file.value()) : Encoded{};
}

std::string failure(const RasterImage& image, const TriangleMesh& mesh, const EncodeOptions& options = kExact) {
    const Result<Encoded> file = refit_raster(image, mesh, options);
    return file.ok() ? "" : file.error().message;
}

// The values of all samples of a file.
std::vector<double> values_of(const std::vector<uint8_t>& file) {
    Decoder decoder;
    gim_raster_info info;
    EXPECT_EQ(decoder.open(file), GIM_OK);
    EXPECT_EQ(gim_read_raster_info(&decoder.info(), file.data(), file.size(), &info), GIM_OK);
    std::vector<uint8_t> defined(size_t{info.width} * info.height);
    std::vector<int32_t> numbers(defined.size() * info.channels);
    Scratch scratch(info.scratch_size);
    EXPECT_EQ(gim_decode_raster(&decoder.info(), file.data(), file.size(), numbers.data(), defined.data(),
                                scratch.data(), scratch.size()),
              GIM_OK);
    std::vector<double> values;
    for (size_t i = 0; i < numbers.size(); ++i) {
        gim_raster_channel c;
        EXPECT_EQ(gim_read_raster_channel(&decoder.info(), file.data(), file.size(),
                                          static_cast<uint32_t>(i % info.channels), &c),
                  GIM_OK);
        values.push_back(defined[i / info.channels] ? c.origin + c.step * numbers[i] : 0);
    }
    return values;
}

TriangleMesh decoded(const Encoded& file) {
    const Result<Mesh> surface = decode_surface(file.bytes, 0);
    EXPECT_TRUE(surface.ok());
    TriangleMesh mesh;
    for (const Vec3& p : surface.value().positions) mesh.positions.push_back({p.x(), p.y(), p.z()});
    mesh.triangles = surface.value().triangles;
    return mesh;
}

double psnr_of(const TriangleMesh& mesh, const Encoded& file) { return compare(mesh, decoded(file), {}).value().psnr; }

TEST(RefitRaster, SamplesComeNearerToTheMesh) {
    const TriangleMesh mesh = potato();
    const RasterImage image = potato_image();
    const Result<Encoded> plain = encode_raster(image, kExact);
    ASSERT_TRUE(plain.ok());
    const Encoded fitted = refitted(image, mesh);
    EXPECT_GT(psnr_of(mesh, fitted), psnr_of(mesh, plain.value()) + 6);
    EXPECT_NEAR(fitted.report.error.psnr, psnr_of(mesh, fitted), 0.3);
    // Closed as before, of the same shape.
    const TopologySummary topology = summarize_topology(decoded(fitted));
    EXPECT_TRUE(topology.watertight);
    EXPECT_EQ(topology.components, 1u);
    EXPECT_EQ(fitted.report.open_samples, 0u);
    EXPECT_EQ(fitted.report.charts, 6u);
    EXPECT_EQ(fitted.report.input_triangles, mesh.triangles.size());
    EXPECT_EQ(fitted.report.folds, 0u);
}

TEST(RefitRaster, TargetsCountAgainstTheMesh) {
    const TriangleMesh mesh = potato();
    const RasterImage image = potato_image();
    const double best = refitted(image, mesh).report.error.psnr;
    const Encoded file = refitted(image, mesh, options_of({RateTarget::Kind::kPsnr, best - 6}));
    EXPECT_GT(psnr_of(mesh, file), best - 6.2);
    const Encoded small = refitted(image, mesh, options_of({RateTarget::Kind::kBytes, 1200}));
    EXPECT_LE(small.bytes.size(), 1200u);
    const Encoded near = refitted(image, mesh, options_of({RateTarget::Kind::kMaxError, 0.02, true}));
    EXPECT_LE(near.report.error.hausdorff, 0.02 * near.report.error.diagonal);
    EXPECT_LT(refitted(image, mesh, options_of({RateTarget::Kind::kQuality, 30})).bytes.size(),
              refitted(image, mesh, options_of({RateTarget::Kind::kQuality, 70})).bytes.size());
    EXPECT_NE(failure(image, mesh, options_of({RateTarget::Kind::kPsnr, 150})).find("the fitted image has"),
              std::string::npos);
}

TEST(RefitRaster, WithoutAFitOnlyTheReferenceChanges) {
    EncodeOptions options = kExact;
    options.fit = FitStrength::kOff;
    const Encoded file = refitted(potato_image(), potato(), options);
    EXPECT_EQ(file.bytes, encode_raster(potato_image(), kExact).value().bytes);
    EXPECT_NEAR(file.report.error.psnr, psnr_of(potato(), file), 0.3);
}

// Scales the samples of one piece.
void scale_piece(RasterImage& image, uint32_t piece, double scale) {
    for (size_t i = 0; i < image.defined.size(); ++i) {
        if (i % image.width / (kSide + 1) != piece) continue;
        for (size_t k = 0; k < 3; ++k) image.values[i * image.channels + k] *= scale;
    }
}

TEST(RefitRaster, OpenBordersStayWhereTheyAreOnAClosedMesh) {
    RasterImage image = potato_image();
    scale_piece(image, 5, 1.002);  // too far away to be glued
    EncodeOptions options = kExact;
    options.bits = 18;
    const Encoded file = refitted(image, potato(), options);
    EXPECT_GE(file.report.open_samples, 2 * 4 * (kSide - 2));
    const std::vector<double> values = values_of(file.bytes);
    double farthest_open = 0, farthest = 0;
    for (size_t i = 0; i < image.defined.size(); ++i) {
        if (i % image.width / (kSide + 1) != 5) continue;
        const size_t row = i / image.width, column = i % image.width % (kSide + 1);
        const double moved =
            std::hypot(values[3 * i] - image.values[3 * i], values[3 * i + 1] - image.values[3 * i + 1],
                       values[3 * i + 2] - image.values[3 * i + 2]);
        const bool is_open = row == 0 || row == kSide - 1 || column == 0 || column == kSide - 1;
        (is_open ? farthest_open : farthest) = std::max(is_open ? farthest_open : farthest, moved);
    }
    EXPECT_LT(farthest_open, 0.04);
    EXPECT_GT(farthest, 0.1);
}

TEST(RefitRaster, BordersGoToTheBoundaryOfTheMesh) {
    // Five sides of the cube, finely sampled.
    const Result<Encoded> fine = encode_raster(potato_image(5, 49), options_of({RateTarget::Kind::kLossless, 0}, 20));
    ASSERT_TRUE(fine.ok());
    const TriangleMesh mesh = decoded(fine.value());
    ASSERT_EQ(summarize_topology(mesh).boundary_loops, 1u);
    RasterImage image = potato_image(5);
    for (double& v : image.values) v *= 1.003;
    EncodeOptions options = kExact;
    options.bits = 18;
    const Encoded file = refitted(image, mesh, options);
    const TriangleMesh test = decoded(file);
    // Both boundaries run along each other. One has four times as many samples as the other.
    const auto curve_of = [](const TriangleMesh& m) {
        Mesh surface;
        for (const Point& p : m.positions) surface.positions.emplace_back(p[0], p[1], p[2]);
        surface.triangles = m.triangles;
        return boundary_curve(surface);
    };
    const Mesh expected = curve_of(mesh), found = curve_of(test);
    const ClosestPointTree tree(expected);
    EXPECT_EQ(found.triangles.size(), 4 * (kSide - 1));
    for (const Triangle& edge : found.triangles)
        EXPECT_LT(std::sqrt(tree.find(found.positions[edge[0]]).squared_distance), 1e-3);
    EXPECT_GT(psnr_of(mesh, file), 60);
}

TEST(RefitRaster, WholeNumbersStayWholeAndOtherChannelsStay) {
    RasterImage image = potato_image();
    RasterImage whole = image;
    whole.type = SampleType::kUint16;
    whole.channels = 4;
    whole.values.clear();
    for (size_t i = 0; i < image.values.size(); i += 3) {
        for (size_t k = 0; k < 3; ++k)
            whole.values.push_back(image.defined[i / 3] ? std::round(20 * image.values[i + k] + 300) : 0);
        whole.values.push_back(image.defined[i / 3] ? static_cast<double>(i % 251) : 0);
    }
    TriangleMesh mesh = potato();
    EXPECT_NE(failure(whole, mesh).find("in the same coordinates"), std::string::npos);
    for (Point& p : mesh.positions)
        for (double& x : p) x = 20 * x + 300;
    const Encoded file = refitted(whole, mesh);
    const std::vector<double> values = values_of(file.bytes);
    size_t moved = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(values[i], std::round(values[i]));
        if (i % 4 == 3) {
            EXPECT_EQ(values[i], whole.values[i]);
        }
        moved += values[i] != whole.values[i] ? 1 : 0;
    }
    EXPECT_GT(moved, values.size() / 20);
    EXPECT_GT(psnr_of(mesh, file), psnr_of(mesh, encode_raster(whole, kExact).value()) + 1);
}

TEST(RefitRaster, MeshesThatAreNoSurfaceAreRefusedOrRepaired) {
    const RasterImage image = potato_image();
    EXPECT_NE(failure(image, {}).find("the mesh to fit to"), std::string::npos);
    TriangleMesh broken = potato();
    broken.positions[7][1] = NAN;
    EXPECT_NE(failure(image, broken).find("the mesh to fit to"), std::string::npos);
    TriangleMesh crowded = potato();
    const auto [a, b, c] = crowded.triangles[0];
    crowded.positions.push_back({0, 0, 0});
    crowded.triangles.push_back({a, b, static_cast<uint32_t>(crowded.positions.size() - 1)});
    EncodeOptions strict = kExact;
    strict.strict = true;
    EXPECT_NE(failure(image, crowded, strict).find("the mesh to fit to"), std::string::npos);
    const Encoded repaired = refitted(image, crowded);
    EXPECT_GT(repaired.report.repairs.crowded_edges, 0u);
    EXPECT_EQ(failure(potato_image(), potato()), "");
    EXPECT_NE(failure(potato_image(1), potato()).find("lie"), std::string::npos);
}

TEST(RefitRaster, ThreadsDoNotChangeTheBytes) {
    EncodeOptions options = options_of({RateTarget::Kind::kQuality, 60});
    const std::vector<uint8_t> one = refitted(potato_image(), potato(), options).bytes;
    options.threads = 2;
    EXPECT_EQ(refitted(potato_image(), potato(), options).bytes, one);
}

}  // namespace
}  // namespace gim
