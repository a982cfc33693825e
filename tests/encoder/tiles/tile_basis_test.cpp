#include "encoder/tiles/tile_basis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/encoder/tiles/made_tiles.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using namespace gim::test;

constexpr DetailCoding kCoding{8, true, 3, 900};
constexpr uint32_t kExponent = 3;

std::vector<float> noise(size_t count, uint64_t seed) {
    Random random(seed);
    std::vector<float> values(count);
    for (float& v : values) v = 2 * random.unit() - 1;
    return values;
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += double{a[i]} * double{b[i]};
    return sum;
}

// A basis of a made complex. repeated: every place has its own sample of the image, as in an atlas.
struct MadeBasis {
    MadeBasis(const MadeQuads& made, bool repeated, bool sharp, const DetailCoding& coding = kCoding) {
        const TileImage image = tile_image(made, kExponent);
        auto complex = complex_of(image.quads, image.vertices);
        coded = std::make_unique<CodedComplex>(code_complex(image, complex.value().view()));
        samples = coded_samples(*coded, complex.value().view(), 1u << kExponent);
        std::vector<float> units;
        for (const Vec3& p : image.positions)
            for (int k = 0; k < 3; ++k) units.push_back(static_cast<float>(1000 * p[k]));
        if (repeated) {
            std::vector<float> grids;
            for (const uint32_t s : samples)
                grids.insert(grids.end(), &units[3 * size_t{s}], &units[3 * size_t{s}] + 3);
            units = grids;
            for (size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<uint32_t>(i);
        }
        values = units;
        const QuadComplex& view = coded->complex.view();
        shape = {view.tiles, view.vertices, view.edges - 2 * view.tiles, kExponent, sharp, false};
        basis = std::make_unique<TileBasis>(values, TilePlaces{view, samples, values.size() / 3}, shape, coding);
    }

    std::unique_ptr<CodedComplex> coded;
    std::vector<uint32_t> samples;
    std::vector<float> values;
    TileShape shape;
    std::unique_ptr<TileBasis> basis;
};

template <class F>
void for_each_basis(const F& f) {
    for (const MadeQuads& made : all_made_quads()) {
        for (const bool repeated : {false, true}) {
            for (const bool sharp : {false, true}) {
                SCOPED_TRACE(made.name + (repeated ? " repeated" : "") + (sharp ? " sharp" : ""));
                const MadeBasis m(made, repeated, sharp);
                f(m);
            }
        }
    }
}

TEST(TileBasis, ImagesComeBackFromTheirCoordinates) {
    for_each_basis([](const MadeBasis& m) {
        const auto c = m.basis->analyse(m.values);
        ASSERT_EQ(c.size(), m.basis->size());
        const auto back = m.basis->synthesize(c);
        ASSERT_EQ(back.size(), m.values.size());
        for (size_t i = 0; i < back.size(); ++i) ASSERT_NEAR(back[i], m.values[i], 4e-6f * 12000);
        for (size_t i = 0; i < c.size(); ++i) {
            if (m.basis->is_copy(i)) {
                ASSERT_EQ(c[i], 0);
            }
        }
    });
}

TEST(TileBasis, TransposedIsTheAdjointOfSynthesis) {
    for_each_basis([](const MadeBasis& m) {
        for (uint64_t seed = 1; seed < 4; ++seed) {
            auto c = noise(m.basis->size(), seed);
            const auto x = noise(m.values.size(), seed + 100);
            const auto synthesized = m.basis->synthesize(c);
            const double length = std::sqrt(dot(synthesized, synthesized) * dot(x, x));
            EXPECT_NEAR(dot(synthesized, x), dot(c, m.basis->transposed(x)), 1e-6 * length);
        }
    });
}

TEST(TileBasis, CopiesHaveNoEffect) {
    const MadeBasis m(cube(), false, false);
    ImageBasis::Coordinates c(m.basis->size(), 0.0f);
    size_t copies = 0;
    for (size_t i = 0; i < c.size(); ++i) {
        if (!m.basis->is_copy(i)) continue;
        c[i] = 5;
        ++copies;
    }
    EXPECT_EQ(copies, 3 * 12 * (1u + 2 + 4));
    for (const float x : m.basis->synthesize(c)) ASSERT_EQ(x, 0);
    const auto t = m.basis->transposed(noise(m.values.size(), 4));
    for (size_t i = 0; i < t.size(); ++i) {
        if (m.basis->is_copy(i)) {
            ASSERT_EQ(t[i], 0);
        }
    }
}

TEST(TileBasis, NormsAreThoseOfSynthesisFunctions) {
    // A torus is regular; functions of the finest details and of those before do not meet themselves.
    for (const bool sharp : {false, true}) {
        const MadeBasis m(torus(6, 6), false, sharp);
        const size_t count = m.basis->size();
        for (size_t i = m.basis->base_size(); i < count; i += 997) {
            if (m.basis->is_copy(i)) continue;
            ImageBasis::Coordinates c(count, 0.0f);
            c[i] = 1;
            const auto function = m.basis->synthesize(c);
            EXPECT_NEAR(std::sqrt(dot(function, function)) / m.basis->norm(i), 1, 2e-2) << i;
        }
    }
}

TEST(TileBasis, StepsFollowBandAndArea) {
    const MadeBasis with(torus(4, 4), false, false), without(torus(4, 4), false, false, {8, true, 3, 0});
    for (size_t i = with.basis->base_size(); i < with.basis->size(); ++i) {
        const bool tangential = i % 3 != 0;
        ASSERT_EQ(with.basis->is_tangential(i), tangential);
        ASSERT_FLOAT_EQ(without.basis->step(i) * without.basis->norm(i), tangential ? 24 : 8);
        const float scale = with.basis->step(i) / without.basis->step(i);
        if (tangential) {
            ASSERT_FLOAT_EQ(scale, 1);
        } else {
            ASSERT_NEAR(std::pow(scale, -4), with.basis->relative_area(i), 1e-3f * with.basis->relative_area(i));
        }
    }
}

}  // namespace
}  // namespace gim
