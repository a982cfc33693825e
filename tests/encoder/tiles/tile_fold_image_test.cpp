#include "encoder/tiles/tile_fold_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "encoder/code/file_units.h"
#include "encoder/tiles/tile_pyramid.h"
#include "encoder/tiles/tile_responses.h"
#include "encoder/tiles/write_tiles.h"
#include "tests/encoder/tiles/made_tiles.h"

namespace gim {
namespace {

using namespace gim::test;

constexpr uint32_t kExponent = 3, kSide = 1u << kExponent, kGrid = (kSide + 1) * (kSide + 1);

// The integers of a made image, and all that the repair asks of them.
struct MadeImage {
    MadeImage(const MadeQuads& made, bool sharp) {
        TileImage tiles = tile_image(made, kExponent, 0.02);
        tiles.is_sharp = sharp;
        auto complex = complex_of(tiles.quads, tiles.vertices);
        coded = std::make_unique<CodedComplex>(code_complex(tiles, complex.value().view()));
        const QuadComplex& view = coded->complex.view();
        shape = shape_of(tiles, view, false);
        texels = texels_of(*coded, kSide);
        units = tile_units(tiles, 12).value();
        units.quantizer = 8;
        std::vector<Vec3> grids;
        for (const uint32_t s : coded_samples(*coded, complex.value().view(), kSide))
            grids.push_back(tiles.positions[s]);
        std::vector<float> values = to_units<float>(grids, units);
        const DetailCoding coding = detail_coding_of(units);
        if (sharp) {
            pyramid = quantize_tiles<TilesSharp>(view, shape, analyse_tiles<TilesSharp>(view, values, kExponent),
                                                 coding, &decoded);
        } else {
            pyramid =
                quantize_tiles<Tiles97>(view, shape, analyse_tiles<Tiles97>(view, values, kExponent), coding, &decoded);
        }
        responses = std::make_unique<TileResponses>(view, shape, texels.of_sample);
        image = std::make_unique<TileFoldImage>(view, shape, texels, *responses, pyramid, units);
    }

    const QuadComplex& view() const { return coded->complex.view(); }

    // Calls f(place) for all details of all tiles.
    template <class F>
    void for_each_place(const F& f) {
        for (uint32_t tile = 0; tile < view().tiles; ++tile) {
            for (uint32_t depth = 1; depth <= kExponent; ++depth) {
                for (const auto o : {Orientation::kHorizontal, Orientation::kVertical, Orientation::kDiagonal}) {
                    PlaceInPart place{tile, depth, o, 0, 0};
                    const Band band = image->band(place);
                    for (place.row = 0; place.row < band.rows; ++place.row)
                        for (place.column = 0; place.column < band.columns; ++place.column) f(place);
                }
            }
        }
    }

    std::unique_ptr<CodedComplex> coded;
    TileShape shape;
    TileTexels texels;
    Units units;
    TilePyramid<int32_t> pyramid;
    std::vector<float> decoded;
    std::unique_ptr<TileResponses> responses;
    std::unique_ptr<TileFoldImage> image;
};

template <class F>
void for_each_image(const F& f) {
    for (const MadeQuads& made : all_made_quads()) {
        for (const bool sharp : {false, true}) {
            SCOPED_TRACE(made.name + (sharp ? " sharp" : ""));
            MadeImage m(made, sharp);
            f(m);
        }
    }
}

TEST(TileFoldImage, DecodesWhatTheQuantizerSaysThatADecoderHas) {
    for_each_image([](const MadeImage& m) { EXPECT_EQ(m.image->decode()[0].back(), m.decoded); });
}

// The samples that a detail moves by a part of most that counts, and by how much.
std::map<uint32_t, float> weights_of(const WeightedSamples& moved) {
    std::map<uint32_t, float> weights;
    for (const auto& [v, weight] : moved) weights[v] += weight;
    return weights;
}

TEST(TileFoldImage, ATrialDecodesTheChangeAndMakesNone) {
    for_each_image([](MadeImage& m) {
        const CodedImage::Levels before = m.image->decode();
        uint32_t count = 0;
        m.for_each_place([&](const PlaceInPart& place) {
            if (m.image->source_of(place) != place || count++ % 29 != 0) return;
            const uint32_t k = count % 3;
            const CodedImage::Levels trial = m.image->decode_changed(place, k, 2);
            ASSERT_EQ(m.image->decode(), before);
            int32_t& integer = m.image->band(place).row(place.row)[3 * place.column + k];
            integer += 2;
            EXPECT_EQ(m.image->decode(), trial);
            integer -= 2;
        });
        EXPECT_GT(count, 0u);
    });
}

// The change of finer details' frames is left out, so only the finest details are looked at.
TEST(TileFoldImage, AChangeMovesTheSamplesThatItSays) {
    for_each_image([](MadeImage& m) {
        const CodedImage::Levels before = m.image->decode();
        const std::vector<float> was = m.image->samples(before);
        uint32_t count = 0;
        m.for_each_place([&](const PlaceInPart& place) {
            if (place.depth > 1 || m.image->source_of(place) != place || count++ % 7 != 0) return;
            const uint32_t k = count % 3;
            const DetailFrame frame = m.image->frame(before, place);
            float step[3];
            steps_in(frame, m.image->steps_at(place.depth), place.orientation, step);
            int32_t& integer = m.image->band(place).row(place.row)[3 * place.column + k];
            const float length = dequantize(integer + 3, step[k]) - dequantize(integer, step[k]);
            integer += 3;
            const std::vector<float> is = m.image->samples(m.image->decode());
            integer -= 3;
            const auto weights = weights_of(m.image->moved_by(place));
            float most = 0;
            for (const auto& [v, weight] : weights) most = std::max(most, std::abs(weight));
            ASSERT_GT(most, 0.3f);
            for (uint32_t v = 0; v < is.size() / 3; ++v) {
                const auto found = weights.find(v);
                const float weight = found == weights.end() ? 0 : found->second;
                for (size_t i = 0; i < 3; ++i) {
                    ASSERT_NEAR(is[3 * v + i] - was[3 * v + i], weight * length * frame.axis[k][i],
                                0.021f * most * std::abs(length) + 0.01f);
                }
            }
        });
        EXPECT_GT(count, 0u);
    });
}

// On a patch of tiles each detail must have the function that it has on all tiles. A patch is two tiles wide around. The
// functions of the coarsest details here are wider, but small there.
TEST(TileFoldImage, DetailsOfEveryDepthMoveWhatTheWaveletMoves) {
    for_each_image([](MadeImage& m) {
        uint32_t count = 0;
        m.for_each_place([&](const PlaceInPart& place) {
            if (m.image->source_of(place) != place || count++ % 11 != 0) return;
            TilePyramid<float> one;
            one.base.resize(3 * size_t{m.view().vertices});
            for (const auto& details : m.pyramid.details) one.details.emplace_back(details.size());
            const size_t at = static_cast<size_t>(&m.image->band(place).row(place.row)[3 * place.column] -
                                                  m.pyramid.details[kExponent - place.depth].data());
            one.details[kExponent - place.depth][at] = 1;
            const std::vector<float> grids =
                m.shape.is_sharp ? restore_tiles<TilesSharp>(m.view(), one) : restore_tiles<Tiles97>(m.view(), one);
            const auto weights = weights_of(m.image->moved_by(place));
            float most = 0;
            for (const float w : grids) most = std::max(most, std::abs(w));
            for (uint32_t i = 0; i < m.texels.of_sample.size(); ++i) {
                const auto found = weights.find(m.texels.of_sample[i]);
                ASSERT_NEAR(found == weights.end() ? 0 : found->second, grids[3 * i],
                            (place.depth < 3 ? 0.0201f : 0.04f) * most);
            }
        });
        EXPECT_GT(count, 0u);
    });
}

TEST(TileFoldImage, DetailsOnAnEdgeAreThoseOfOneTile) {
    for_each_image([](MadeImage& m) {
        const std::vector<float> was = m.image->samples(m.image->decode());
        uint32_t copies = 0;
        m.for_each_place([&](const PlaceInPart& place) {
            const PlaceInPart source = m.image->source_of(place);
            ASSERT_EQ(m.image->source_of(source), source);
            if (source == place) return;
            if (copies++ % 5 != 0) return;
            int32_t& copy = m.image->band(place).row(place.row)[3 * place.column];
            copy += 40;
            ASSERT_EQ(m.image->samples(m.image->decode()), was);
            copy -= 40;
            // The detail is that of the same place on the edge: it moves the sample there most, or almost.
            const uint32_t row = (2 * place.row + (place.orientation == Orientation::kVertical)) << (place.depth - 1);
            const uint32_t column = (2 * place.column + (place.orientation == Orientation::kHorizontal))
                                    << (place.depth - 1);
            const uint32_t texel = m.texels.of_sample[place.part * kGrid + row * (kSide + 1) + column];
            const auto weights = weights_of(m.image->moved_by(source));
            ASSERT_TRUE(weights.contains(texel));
            for (const auto& [v, weight] : weights) ASSERT_LE(0.9f * std::abs(weight), std::abs(weights.at(texel)));
        });
        EXPECT_EQ(copies == 0, m.view().tiles == 1);
    });
}

TEST(TileFoldImage, EachCellKnowsItsPlaceInTheTilesAround) {
    for_each_image([](MadeImage& m) {
        const std::vector<float> samples = m.image->samples(m.image->decode());
        const auto at = [&](uint32_t tile, double row, double column) {
            const auto sample = tile * kGrid + static_cast<uint32_t>(row) * (kSide + 1) + static_cast<uint32_t>(column);
            const float* p = &samples[3 * size_t{m.texels.of_sample[sample]}];
            return std::array<float, 3>{p[0], p[1], p[2]};
        };
        const uint32_t width = m.texels.width;
        size_t beside_border = 0;
        for (uint32_t texel = 0; texel + width + 1 < m.texels.sample_at.size(); ++texel) {
            const uint32_t first = m.texels.sample_at[texel], last = m.texels.sample_at[texel + width + 1];
            if (texel % width + 1 == width || first == kNone || last == kNone || first / kGrid != last / kGrid)
                continue;
            const std::vector<CellInPart> parts = m.image->parts_at(texel / width * (width - 1) + texel % width);
            const CellInPart& own = parts[0];
            ASSERT_EQ(own.part, first / kGrid);
            std::array<std::array<float, 3>, 4> corners;
            for (size_t i = 0; i < 4; ++i)
                corners[i] = at(own.part, own.row + (i / 2 ? 0.5 : -0.5), own.column + (i % 2 ? 0.5 : -0.5));
            const auto is_corner = [&](const std::array<float, 3>& p) {
                return std::find(corners.begin(), corners.end(), p) != corners.end();
            };
            const float* p = &samples[3 * size_t{texel}];
            ASSERT_TRUE(is_corner({p[0], p[1], p[2]}));
            // The two corners on a border are samples of the tile beside it.
            for (size_t i = 1; i < parts.size(); ++i) {
                const CellInPart& other = parts[i];
                const double row = std::clamp(other.row, 0.0, double{kSide});
                const double column = std::clamp(other.column, 0.0, double{kSide});
                if (std::abs(row - other.row) + std::abs(column - other.column) > 0.6) continue;
                ++beside_border;
                const bool along_row = row != other.row;
                ASSERT_TRUE(is_corner(at(other.part, along_row ? row : row - 0.5, along_row ? column - 0.5 : column)));
                ASSERT_TRUE(is_corner(at(other.part, along_row ? row : row + 0.5, along_row ? column + 0.5 : column)));
            }
        }
        EXPECT_EQ(beside_border == 0, m.view().tiles == 1);
    });
}

}  // namespace
}  // namespace gim
