// Files whose surfaces must not fold: mesh -> .gim -> mesh, and what a person would see.
#include <gtest/gtest.h>

#include <cstddef>

#include "corpus/corpus.h"
#include "encoder/code/decode_surface.h"
#include "encoder/surface/defects.h"
#include "encoder/surface/refine.h"
#include "gim/encoder.h"
#include "tests/encoder/grid_images.h"

namespace gim {
namespace {

EncodeOptions square_options(const RateTarget& rate) {
    EncodeOptions options;
    options.side = 65;
    options.rate = rate;
    return options;
}

EncodeOptions chart_options(const RateTarget& rate) {
    EncodeOptions options = square_options(rate);
    options.layout = Layout::kMcgim;
    options.samples = 2500;
    return options;
}

// The decoded surface and what is wrong with it.
struct Looked {
    Mesh surface;
    size_t faces = 0;
    Defects defects;
    double psnr = 0;
    size_t bytes = 0;
};

Looked look_at(const TriangleMesh& mesh, const EncodeOptions& options) {
    const auto encoded = encode(mesh, options);
    EXPECT_TRUE(encoded.ok()) << encoded.error().message;
    if (!encoded.ok()) return {};
    Looked looked;
    looked.surface = decode_surface(encoded.value().bytes, 0).value();
    looked.faces = looked.surface.triangles.size();
    looked.bytes = encoded.value().bytes.size();
    TriangleMesh test;
    for (const Vec3& p : looked.surface.positions) test.positions.push_back({p.x(), p.y(), p.z()});
    test.triangles = looked.surface.triangles;
    const Comparison comparison = compare(mesh, test, {.samples = 50000, .defects = true}).value();
    looked.defects = *comparison.defects;
    looked.psnr = comparison.psnr;
    return looked;
}

// No face folds, and no area is lost or gained but `most` of all.
void expect_flat(const EncodeOptions& options, double most) {
    const TriangleMesh mesh = corpus::disk(8, 64);  // a fan of 64 triangles, and a grid of rings around it
    const Looked looked = look_at(mesh, options);
    EXPECT_EQ(looked.defects.folded_faces, 0u);
    EXPECT_EQ(looked.defects.folded_back_edges, 0u);
    EXPECT_NEAR(surface_area(looked.surface) / surface_area(mesh_of(mesh)), 1, most);
}

// One in `faces_per_fold` may fold.
void expect_hardly_a_fold(const TriangleMesh& mesh, const EncodeOptions& options, size_t faces_per_fold) {
    const Looked looked = look_at(mesh, options);
    const size_t most = looked.faces / faces_per_fold;
    EXPECT_LE(looked.defects.folded_faces, most);
    EXPECT_LE(looked.defects.folded_back_edges, looked.defects.folded_back_edges_of_reference + most);
    EXPECT_LE(looked.defects.folded_area, 2.0 / static_cast<double>(faces_per_fold));
}

TEST(EncodeFolds, AFlatDiskComesBackFlat) { expect_flat(square_options({RateTarget::Kind::kQuality, 75}), 1e-3); }
TEST(EncodeFolds, AFlatDiskWithoutLossComesBackFlat) {
    expect_flat(square_options({RateTarget::Kind::kLossless, 0}), 1e-3);
}
// At 70 dB the RMS distance is 0.0009, so that much of the rim may be missing.
TEST(EncodeFolds, AFlatDiskComesBackFlatAtATarget) { expect_flat(square_options({RateTarget::Kind::kPsnr, 70}), 2e-3); }

// The quantizer of charts rounds off their borders: 0.3 % of the area at quality 75.
TEST(EncodeFolds, AFlatDiskOfChartsComesBackFlat) {
    expect_flat(chart_options({RateTarget::Kind::kQuality, 75}), 5e-3);
}
TEST(EncodeFolds, AFlatDiskOfChartsWithoutLossComesBackFlat) {
    expect_flat(chart_options({RateTarget::Kind::kLossless, 0}), 1e-3);
}

// The qualities give about 59 and 69 dB.
TEST(EncodeFolds, LongLimbsHaveHardlyAFold) {
    expect_hardly_a_fold(corpus::limbed_blob(24), square_options({RateTarget::Kind::kQuality, 60}), 1000);
}
TEST(EncodeFolds, LongLimbsInDetailHaveHardlyAFold) {
    expect_hardly_a_fold(corpus::limbed_blob(30), square_options({RateTarget::Kind::kQuality, 90}), 1000);
}

TEST(EncodeFolds, LongLimbsOfChartsHaveHardlyAFold) {
    expect_hardly_a_fold(corpus::limbed_blob(24), chart_options({RateTarget::Kind::kQuality, 60}), 1000);
}

}  // namespace
}  // namespace gim
