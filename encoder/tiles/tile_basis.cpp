#include "encoder/tiles/tile_basis.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "encoder/tiles/tile_pyramid.h"
#include "encoder/tiles/transpose_tiles.h"
#include "format/tile_frames.h"
#include "format/tile_norms.h"

namespace gim {
namespace {

std::vector<float> flat(const TilePyramid<float>& pyramid) {
    std::vector<float> out = pyramid.base;
    for (const auto& details : pyramid.details) out.insert(out.end(), details.begin(), details.end());
    return out;
}

TilePyramid<float> unflattened(const std::vector<float>& values, const QuadComplex& complex, uint32_t exponent) {
    TilePyramid<float> pyramid;
    auto at = values.begin() + 3 * ptrdiff_t{complex.vertices};
    pyramid.base.assign(values.begin(), at);
    for (uint32_t e = 1; e <= exponent; ++e) {
        const auto count = static_cast<ptrdiff_t>(complex.tiles * TilePlanes(1u << (e - 1)).details());
        pyramid.details.emplace_back(at, at + count);
        at += count;
    }
    return pyramid;
}

// The sizes of a tile's bands at h intervals.
struct BandSize {
    Orientation orientation;
    uint32_t rows, columns;
};
std::array<BandSize, 3> bands_at(uint32_t h) {
    return {{{Orientation::kHorizontal, h + 1, h}, {Orientation::kVertical, h, h + 1}, {Orientation::kDiagonal, h, h}}};
}

// Whether another tile has the detail.
bool is_copied(const QuadComplex& complex, uint32_t tile, const BandSize& band, uint32_t row, uint32_t column) {
    const auto is_known = [&](uint32_t side) { return complex.mate[4 * tile + side] < 4 * tile + side; };
    if (band.orientation == Orientation::kHorizontal)
        return (row == 0 && is_known(0)) || (row + 1 == band.rows && is_known(2));
    if (band.orientation == Orientation::kVertical)
        return (column == 0 && is_known(3)) || (column + 1 == band.columns && is_known(1));
    return false;
}

}  // namespace

TileBasis::TileBasis(const std::vector<float>& image, const TilePlaces& places, const TileShape& shape,
                     const DetailCoding& coding)
    : places_(places), is_sharp_(shape.is_sharp), exponent_(shape.exponent), is_first_(places.samples.size()) {
    const QuadComplex& complex = places.complex;
    std::vector<bool> seen(places.count);
    for (size_t i = 0; i < is_first_.size(); ++i) {
        is_first_[i] = !seen[places.samples[i]];
        seen[places.samples[i]] = true;
    }

    const float low_norm = tile_norms(shape, exponent_).low;
    add_base(complex.vertices, tile_base_step(shape, coding.quantizer), low_norm);
    for (uint32_t v = 0; v < complex.vertices; ++v)
        norms_[v] = low_norm * std::sqrt(static_cast<float>(complex.valence[v]) / 4);
    is_copy_.assign(complex.vertices, false);
    // The frames are those of the small images, coarsest first.
    std::vector<std::vector<float>> samples(exponent_);
    std::vector<float> sums(6 * size_t{complex.vertices});
    const auto keep = [&](const TilePlanes& planes, float* values) {
        is_sharp_ ? analyse_step<TilesSharp>(complex, planes, values, sums.data())
                  : analyse_step<Tiles97>(complex, planes, values, sums.data());
        samples[static_cast<size_t>(std::countr_zero(planes.h))].assign(values, values + complex.tiles * planes.size());
    };
    (void)split_tiles(complex, grids_of(image), exponent_, keep);
    for (uint32_t e = 1; e <= exponent_; ++e) {
        const TilePlanes planes(1u << (e - 1));
        const DetailSteps steps = tile_steps_at(shape, coding, exponent_ - e + 1);
        const BandNorms& norms = tile_norms(shape, exponent_ - e + 1);
        const TileFrames field(complex, planes, samples[e - 1].data());
        for (uint32_t t = 0; t < complex.tiles; ++t) {
            for (const BandSize& band : bands_at(planes.h)) {
                const float norm = band.orientation == Orientation::kDiagonal ? norms.diagonal : norms.edge;
                for (uint32_t row = 0; row < band.rows; ++row) {
                    for (uint32_t column = 0; column < band.columns; ++column) {
                        is_copy_.push_back(is_copied(complex, t, band, row, column));
                        add_detail(field.at(t, band.orientation, row, column, steps.cell_area), steps, band.orientation,
                                   norm);
                    }
                }
            }
        }
    }
}

std::vector<float> TileBasis::grids_of(const std::vector<float>& image) const {
    std::vector<float> grids;
    grids.reserve(3 * places_.samples.size());
    for (const uint32_t s : places_.samples)
        grids.insert(grids.end(), image.begin() + 3 * ptrdiff_t{s}, image.begin() + 3 * ptrdiff_t{s} + 3);
    return grids;
}

void TileBasis::clear_copies(Coordinates& coordinates) const {
    for (size_t i = 0; i < is_copy_.size(); ++i)
        if (is_copy_[i]) std::fill_n(&coordinates[3 * i], 3, 0.0f);
}

TileBasis::Coordinates TileBasis::analyse(const std::vector<float>& image) const {
    Coordinates coordinates = flat(is_sharp_ ? analyse_tiles<TilesSharp>(places_.complex, grids_of(image), exponent_)
                                             : analyse_tiles<Tiles97>(places_.complex, grids_of(image), exponent_));
    clear_copies(coordinates);
    turn(coordinates, Way::kIntoFrames);
    return coordinates;
}

std::vector<float> TileBasis::synthesize(const Coordinates& coordinates) const {
    Coordinates turned = coordinates;
    turn(turned, Way::kOutOfFrames);
    const TilePyramid<float> pyramid = unflattened(turned, places_.complex, exponent_);
    const std::vector<float> grids = is_sharp_ ? restore_tiles<TilesSharp>(places_.complex, pyramid)
                                               : restore_tiles<Tiles97>(places_.complex, pyramid);
    std::vector<float> image(3 * places_.count);
    for (size_t i = 0; i < places_.samples.size(); ++i)
        std::copy_n(&grids[3 * i], 3, &image[3 * size_t{places_.samples[i]}]);
    return image;
}

TileBasis::Coordinates TileBasis::transposed(std::vector<float> image) const {
    std::vector<float> grids = grids_of(image);
    for (size_t i = 0; i < is_first_.size(); ++i)
        if (!is_first_[i]) std::fill_n(&grids[3 * i], 3, 0.0f);
    Coordinates coordinates =
        flat(is_sharp_ ? restore_tiles_transposed<TilesSharp>(places_.complex, std::move(grids), exponent_)
                       : restore_tiles_transposed<Tiles97>(places_.complex, std::move(grids), exponent_));
    turn(coordinates, Way::kIntoFrames);
    return coordinates;
}

}  // namespace gim
