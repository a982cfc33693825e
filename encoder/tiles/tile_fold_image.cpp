#include "encoder/tiles/tile_fold_image.h"

#include "encoder/surface/mesh.h"
#include "format/tile_atlas.h"
#include "format/tile_frames.h"
#include "format/tile_norms.h"

namespace gim {

namespace {

// A place along a side of a tile, and inwards from it.
struct BesideSide {
    double along, inwards;
};
BesideSide beside(uint32_t side, const CellInPart& at, double length) {
    switch (side) {
        case 0:
            return {at.column, at.row};
        case 1:
            return {at.row, length - at.column};
        case 2:
            return {length - at.column, length - at.row};
        default:
            return {length - at.row, at.column};
    }
}
CellInPart cell_beside(uint32_t half_edge, const BesideSide& at, double length) {
    const uint32_t tile = tile_of(half_edge);
    switch (side_of(half_edge)) {
        case 0:
            return {tile, at.inwards, at.along};
        case 1:
            return {tile, at.along, length - at.inwards};
        case 2:
            return {tile, length - at.inwards, length - at.along};
        default:
            return {tile, length - at.along, at.inwards};
    }
}

// The detail at place t of a half-edge. h: intervals of the small image along a side.
PlaceInPart detail_on(uint32_t half_edge, uint32_t t, uint32_t depth, uint32_t h) {
    const uint32_t tile = tile_of(half_edge);
    switch (side_of(half_edge)) {
        case 0:
            return {tile, depth, Orientation::kHorizontal, 0, t};
        case 1:
            return {tile, depth, Orientation::kVertical, t, h};
        case 2:
            return {tile, depth, Orientation::kHorizontal, h, h - 1 - t};
        default:
            return {tile, depth, Orientation::kVertical, h - 1 - t, 0};
    }
}

}  // namespace

TileTexels texels_of(const CodedComplex& coded, uint32_t side) {
    const uint32_t tiles = coded.complex.view().tiles;
    const TileAtlas atlas(tiles, side);
    TileTexels texels{atlas.width(), {}, std::vector<uint32_t>(atlas.samples(), kNone)};
    texels.of_sample.reserve(tiles * size_t{side + 1} * (side + 1));
    for_each_coded_sample(coded, side, [&](uint32_t tile, uint32_t row, uint32_t column) {
        const uint32_t texel = (atlas.row(tile) + row) * atlas.width() + atlas.column(tile) + column;
        texels.sample_at[texel] = static_cast<uint32_t>(texels.of_sample.size());
        texels.of_sample.push_back(texel);
    });
    return texels;
}

CodedImage::Levels TileFoldImage::decode(const TilePyramid<int32_t>& pyramid) const {
    return {shape_.is_sharp ? decode_tiles<TilesSharp>(complex_, shape_, pyramid, coding_)
                            : decode_tiles<Tiles97>(complex_, shape_, pyramid, coding_)};
}

CodedImage::Levels TileFoldImage::decode_changed(const PlaceInPart& place, uint32_t component, int32_t by) const {
    TilePyramid<int32_t> changed = pyramid_;
    band_in(changed, place).row(place.row)[3 * place.column + component] += by;
    return decode(changed);
}

std::vector<float> TileFoldImage::samples(const Levels& levels) const {
    const std::vector<float>& grids = levels[0].back();
    const auto middle = static_cast<float>(1 << (units_.bits - 1));
    std::vector<float> image(3 * texels_.sample_at.size());
    for (size_t i = 0; i < texels_.of_sample.size(); ++i) {
        for (size_t k = 0; k < 3; ++k) image[3 * size_t{texels_.of_sample[i]} + k] = grids[3 * i + k] + middle;
    }
    return image;
}

DetailFrame TileFoldImage::frame(const Levels& levels, const PlaceInPart& place) const {
    const uint32_t step = shape_.exponent - place.depth;
    const TilePlanes planes(1u << step);
    return TileFrames(complex_, planes, levels[0][step].data())
        .at(place.part, place.orientation, place.row, place.column, steps_at(place.depth).cell_area);
}

DetailSteps TileFoldImage::steps_at(uint32_t depth) const { return tile_steps_at(shape_, coding_, depth); }

Band TileFoldImage::band_in(TilePyramid<int32_t>& pyramid, const PlaceInPart& place) const {
    const uint32_t step = shape_.exponent - place.depth;
    const TilePlanes planes(1u << step);
    return planes.bands(pyramid.details[step].data() + place.part * planes.details()).of(place.orientation);
}

Band TileFoldImage::band(const PlaceInPart& place) { return band_in(pyramid_, place); }

std::vector<Band> TileFoldImage::bands() {
    std::vector<Band> bands;
    for (uint32_t step = 0; step < shape_.exponent; ++step) {
        const TilePlanes planes(1u << step);
        for (uint32_t t = 0; t < complex_.tiles; ++t) {
            const LevelBands of_tile = planes.bands(pyramid_.details[step].data() + t * planes.details());
            bands.insert(bands.end(), {of_tile.horizontal, of_tile.vertical, of_tile.diagonal});
        }
    }
    return bands;
}

std::vector<CellInPart> TileFoldImage::parts_at(uint32_t cell) const {
    const uint32_t intervals = 1u << shape_.exponent, width = texels_.width - 1;
    const uint32_t corner = cell / width * texels_.width + cell % width, opposite = corner + texels_.width + 1;
    const uint32_t first = texels_.sample_at[corner], last = texels_.sample_at[opposite];
    const uint32_t grid = (intervals + 1) * (intervals + 1);
    const auto row = [&](uint32_t sample) { return sample % grid / (intervals + 1); };
    const auto column = [&](uint32_t sample) { return sample % grid % (intervals + 1); };
    const CellInPart own{first / grid, 0.5 * (row(first) + row(last)), 0.5 * (column(first) + column(last))};
    std::vector<CellInPart> parts = {own};
    for (uint32_t s = 0; s < 4; ++s) {
        const uint32_t mate = complex_.mate[4 * own.part + s];
        if (mate == kNoMate) continue;
        const BesideSide at = beside(s, own, intervals);
        parts.push_back(cell_beside(mate, {intervals - at.along, -at.inwards}, intervals));
    }
    return parts;
}

PlaceInPart TileFoldImage::source_of(const PlaceInPart& place) const {
    const uint32_t h = 1u << (shape_.exponent - place.depth);
    const bool is_horizontal = place.orientation == Orientation::kHorizontal;
    const uint32_t across = is_horizontal ? place.row : place.column, along = is_horizontal ? place.column : place.row;
    if (place.orientation == Orientation::kDiagonal || (across > 0 && across < h)) return place;
    const uint32_t side = is_horizontal ? (across == 0 ? 0 : 2) : (across == 0 ? 3 : 1);
    const uint32_t half_edge = 4 * place.part + side, mate = complex_.mate[half_edge];
    if (mate > half_edge) return place;  // as without a mate
    const uint32_t t = side < 2 ? along : h - 1 - along;
    return detail_on(mate, h - 1 - t, place.depth, h);
}

}  // namespace gim
