#include "encoder/tiles/tile_plane.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <utility>

#include "encoder/planes/rectangle_texels.h"
#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/code_tiles.h"
#include "encoder/tiles/tile_pyramid.h"
#include "encoder/tiles/write_tiles.h"
#include "format/plane_code.h"
#include "format/seam.h"
#include "format/tile_atlas.h"

namespace gim {

namespace {

// How far a texel on a sharp edge moves to the next one inside its tile.
constexpr double kInside = 0.125;

// The places of the tiles' texels in their rectangle.
class Slots {
  public:
    Slots(const TileImage& tiles, const TexelGrid& grid)
        : atlas_(static_cast<uint32_t>(tiles.quads.size()), 1u << tiles.exponent),
          exponent_(static_cast<uint32_t>(std::countr_zero((grid.columns - 1) / (atlas_.width() - 1)))),
          columns_(grid.columns),
          side_(1u << (tiles.exponent + exponent_)) {}

    // Texels a sample step, as an exponent of 2.
    uint32_t exponent() const { return exponent_; }
    // Intervals along a side of a tile.
    uint32_t side() const { return side_; }
    size_t at(uint32_t tile, uint32_t row, uint32_t column) const {
        return size_t{(atlas_.row(tile) << exponent_) + row} * columns_ + (atlas_.column(tile) << exponent_) + column;
    }

  private:
    TileAtlas atlas_;
    uint32_t exponent_, columns_, side_;
};

// Gives the copies of a texel in several tiles their mean. grids: per tile (side + 1)^2 triples.
void share_texels(const QuadComplex& complex, uint32_t side, std::vector<float>& grids) {
    const TileSamples samples(complex, side);
    std::vector<double> sum(3 * size_t{samples.inner(0)}, 0.0);
    std::vector<uint32_t> count(samples.inner(0), 0);
    const auto for_each_border = [&](const auto& f) {
        for (uint32_t t = 0; t < complex.tiles; ++t) {
            float* tile = grids.data() + 3 * t * size_t{side + 1} * (side + 1);
            for (uint32_t row = 0; row <= side; ++row) {
                const uint32_t step = row == 0 || row == side ? 1 : side;
                for (uint32_t column = 0; column <= side; column += step)
                    f(samples.at(t, row, column), tile + 3 * (row * size_t{side + 1} + column));
            }
        }
    };
    for_each_border([&](uint32_t sample, const float* value) {
        for (size_t k = 0; k < 3; ++k) sum[3 * size_t{sample} + k] += double{value[k]};
        ++count[sample];
    });
    for_each_border([&](uint32_t sample, float* value) {
        for (size_t k = 0; k < 3; ++k) value[k] = static_cast<float>(sum[3 * size_t{sample} + k] / count[sample]);
    });
}

// An analysed plane with what it takes to code it.
struct TilePlane {
    OwnComplex complex;
    TileShape shape;
    TilePyramid<float> pyramid;
};

}  // namespace

uint8_t tile_plane_exponent(const TileImage& tiles, uint32_t side) {
    const double samples = double(tiles.quads.size()) * std::exp2(2 * tiles.exponent);
    return std::min(texel_exponent(side / std::sqrt(samples)), static_cast<uint8_t>(kMaxSideExponent - tiles.exponent));
}

TexelGrid tile_texels(const TileImage& tiles, const GeometryImage& atlas, uint8_t exponent) {
    TexelGrid grid = rectangle_texels(atlas, exponent);
    if (tiles.sharp.empty()) return grid;
    const Slots slots(tiles, grid);
    std::vector<uint32_t> texel_at(size_t{grid.columns} * grid.rows, kNone);
    for (uint32_t i = 0; i < grid.texels.size(); ++i) texel_at[grid.texels[i].index] = i;
    const uint32_t side = slots.side();
    for (uint32_t t = 0; t < tiles.quads.size(); ++t) {
        const auto is_sharp = [&](uint32_t s) { return tiles.sharp[4 * size_t{t} + s]; };
        const auto move_inside = [&](uint32_t row, uint32_t column) {
            Texel& texel = grid.texels[texel_at[slots.at(t, row, column)]];
            const uint32_t inside =
                texel_at[slots.at(t, std::clamp(row, 1u, side - 1), std::clamp(column, 1u, side - 1))];
            texel.position += kInside * (grid.texels[inside].position - texel.position);
        };
        for (uint32_t i = 0; i <= side; ++i) {
            const bool is_corner = i == 0 || i == side;
            if (is_sharp(0) || (is_corner && is_sharp(i == 0 ? 3 : 1))) move_inside(0, i);
            if (is_sharp(2) || (is_corner && is_sharp(i == 0 ? 3 : 1))) move_inside(side, i);
            if (is_corner) continue;
            if (is_sharp(3)) move_inside(i, 0);
            if (is_sharp(1)) move_inside(i, side);
        }
    }
    return grid;
}

PlaneCoder tile_plane_coder(const TileImage& tiles, const TexelGrid& grid, const std::vector<float>& values) {
    const OwnComplex complex = std::move(complex_of(tiles.quads, tiles.vertices).value());
    CodedComplex coded = code_complex(tiles, complex.view());
    const QuadComplex& view = coded.complex.view();
    const Slots slots(tiles, grid);
    std::vector<float> grids;
    grids.reserve(3 * view.tiles * size_t{slots.side() + 1} * (slots.side() + 1));
    for_each_coded_sample(coded, slots.side(), [&](uint32_t tile, uint32_t row, uint32_t column) {
        const auto value = values.begin() + static_cast<ptrdiff_t>(3 * slots.at(tile, row, column));
        grids.insert(grids.end(), value, value + 3);
    });
    const TileShape shape = shape_of(tiles, view, false);
    return tile_grid_coder(std::move(coded.complex), shape, slots.exponent(), std::move(grids));
}

PlaneCoder tile_grid_coder(OwnComplex complex, const TileShape& shape, uint32_t texels, std::vector<float> grids) {
    const TileShape of_plane = tile_plane_shape(shape, texels);
    share_texels(complex.view(), of_plane.intervals(0), grids);
    TilePyramid<float> pyramid = analyse_tiles<Tiles97>(complex.view(), std::move(grids), of_plane.exponent);
    const auto plane = std::make_shared<const TilePlane>(TilePlane{std::move(complex), of_plane, std::move(pyramid)});
    return [plane](float quantizer) {
        const QuadComplex& on = plane->complex.view();
        TilePyramid<int32_t> integers = quantize_tiles<Tiles97>(on, plane->shape, plane->pyramid, {quantizer});
        return std::move(code_tiles(on, integers, 1, CoefficientKind::kPlanes)[0]);
    };
}

}  // namespace gim
