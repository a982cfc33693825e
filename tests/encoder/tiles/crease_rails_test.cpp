#include "encoder/tiles/crease_rails.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "corpus/generators.h"
#include "encoder/fit/fit_coded.h"
#include "encoder/fit/fitter.h"
#include "encoder/surface/sharp_edges.h"
#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/locate_samples.h"
#include "encoder/tiles/make_tiles.h"
#include "encoder/tiles/tile_codec.h"
#include "encoder/tiles/write_tiles.h"
#include "tests/encoder/tiles/mapped_meshes.h"

namespace gim {
namespace {

constexpr uint32_t kSide = 4;

Mesh cleaned(const TriangleMesh& mesh) { return clean(mesh).value().mesh; }

// How many coordinates lie on a side of the box.
int sides_at(const Vec3& p, const Vec3& half) {
    int sides = 0;
    for (int k = 0; k < 3; ++k) sides += std::abs(std::abs(p[k]) - half[k]) < 1e-9;
    return sides;
}

Vec3 half_of(const Mesh& box) {
    Vec3 half = Vec3::Zero();
    for (const Vec3& p : box.positions) half = half.cwiseMax(p.cwiseAbs());
    return half;
}

OwnComplex complex_of_tiles(const NumberedQuads& numbered) {
    auto complex = complex_of(numbered.quads, static_cast<uint32_t>(numbered.vertices.size()));
    return std::move(complex.value());
}

struct BoxOnRails {
    Mesh box = cleaned(corpus::box(6, 0.8, 0.6));
    Vec3 half = half_of(box);
    MappedMesh mapped = gim::mapped(box, 24, 1);
    std::vector<SurfacePoint> points = locate_samples(mapped.map, kSide).value();
    NumberedQuads numbered = number_quads(mapped.map.quads);
    OwnComplex complex = complex_of_tiles(numbered);
    CreaseRails creases =
        crease_rails(mapped.input.mesh, mapped.input.sharp, mapped.map, points, complex.view(), kSide);

    Vec3 place(uint32_t sample) const {
        const Triangle& t = mapped.map.triangles[points[sample].triangle];
        Vec3 p = Vec3::Zero();
        for (size_t k = 0; k < 3; ++k) p += points[sample].barycentric[k] * mapped.input.mesh.positions[t[k]];
        return p;
    }
};

TEST(CreaseRails, HoldTheEdgesOfABox) {
    const BoxOnRails b;
    const Rails& rails = b.creases.rails;
    ASSERT_EQ(rails.of_sample.size(), b.points.size());
    for (uint32_t s = 0; s < b.points.size(); ++s) {
        const int sides = sides_at(b.place(s), b.half);
        if (sides < 2) {
            EXPECT_EQ(rails.of_sample[s], kNone) << s;
            continue;
        }
        ASSERT_NE(rails.of_sample[s], kNone) << s;
        const std::vector<Vec3>& curve = rails.curves[rails.of_sample[s]];
        EXPECT_EQ(curve.size() == 1, sides == 3) << s;
        for (const Vec3& p : curve) EXPECT_GE(sides_at(p, b.half), sides);
    }
    // The edges of the complex along an edge of the box add up to its length.
    double length = 0;
    const QuadComplex& complex = b.complex.view();
    const TileSamples samples(complex, kSide);
    for (uint32_t h = 0; h < complex.half_edges(); ++h) {
        if (b.creases.half_edge[h]) length += (b.place(samples.along(h, kSide)) - b.place(samples.along(h, 0))).norm();
    }
    EXPECT_NEAR(length / 2, 8 * b.half.sum(), 1e-9);
}

TEST(CreaseRails, SmoothSurfacesHaveNone) {
    const MappedMesh m = mapped(cleaned(corpus::sphere(6)), 12, 1);
    const auto points = locate_samples(m.map, kSide).value();
    const NumberedQuads numbered = number_quads(m.map.quads);
    const OwnComplex complex = complex_of_tiles(numbered);
    const CreaseRails creases = crease_rails(m.input.mesh, m.input.sharp, m.map, points, complex.view(), kSide);
    EXPECT_TRUE(creases.rails.curves.empty());
    EXPECT_TRUE(creases.rails.of_sample.empty());
    EXPECT_EQ(std::count(creases.half_edge.begin(), creases.half_edge.end(), true), 0);
}

// The samples of an image are as far from its rails as rounding puts them.
void expect_on_rails(const std::vector<Vec3>& positions, const Rails& rails, const Vec3& half) {
    size_t held = 0;
    for (uint32_t s = 0; s < positions.size(); ++s) {
        if (rails.of_sample[s] == kNone) continue;
        EXPECT_EQ(sides_at(positions[s], half), rails.curves[rails.of_sample[s]].size() == 1 ? 3 : 2) << s;
        ++held;
    }
    EXPECT_GT(held, 0u);
}

TEST(CreaseRails, SamplesStayOnThemInEveryFit) {
    const Mesh box = cleaned(corpus::box(6, 0.8, 0.6));
    EncodeOptions options;
    options.tiles = 24;
    options.samples = 5000;
    options.rate = {RateTarget::Kind::kPsnr, 60};
    StageClock clock({});
    auto made = make_tiles(make_tileable(box, sharp_edges(box)), box, options, clock);
    ASSERT_TRUE(made.ok()) << made.error().message;
    const MadeTiles& tiles = made.value();
    ASSERT_TRUE(tiles.tiles.is_sharp);
    expect_on_rails(tiles.atlas.positions, tiles.rails, half_of(box));

    const auto make = [&](const FitSetting& setting) -> std::unique_ptr<FitCodec> {
        return std::move(TileCodec::make(tiles.tiles, setting).value());
    };
    CodedFit fit(tiles.atlas, make, box, 1, tiles.rails);
    Units units = tile_units(tiles.tiles, 12).value();
    units.quantizer = 30;
    expect_on_rails(fit.run(units, CodedFit::Effort::kSearch), tiles.rails, half_of(box));
}

}  // namespace
}  // namespace gim
