#include "encoder/tiles/sample_tiles.h"

#include <algorithm>

#include "encoder/tiles/code_complex.h"
#include "format/tile_atlas.h"

namespace gim {

namespace {

// Per sample: whether it lies on a boundary of the complex.
std::vector<bool> boundary_samples(const QuadComplex& complex, const TileSamples& samples, uint32_t side) {
    std::vector<bool> boundary(samples.count(), false);
    for (uint32_t h = 0; h < complex.half_edges(); ++h) {
        if (complex.mate[h] != kNoMate) continue;
        for (uint32_t t = 0; t <= side; ++t) boundary[samples.along(h, t)] = true;
    }
    return boundary;
}

std::vector<uint32_t> texels(const QuadComplex& complex, uint32_t side) {
    const TileSamples samples(complex, side);
    const TileAtlas atlas(complex.tiles, side);
    std::vector<uint32_t> sample(atlas.samples(), kNone);
    for (uint32_t tile = 0; tile < complex.tiles; ++tile) {
        for (uint32_t row = 0; row <= side; ++row) {
            for (uint32_t column = 0; column <= side; ++column)
                sample[size_t{atlas.row(tile) + row} * atlas.width() + atlas.column(tile) + column] =
                    samples.at(tile, row, column);
        }
    }
    return sample;
}

// How the decoder splits a cell of a tile: through the corner of the tile if it has one.
CellKind split_of(uint32_t row, uint32_t column, uint32_t side) {
    const bool top = row == 0, bottom = row + 1 == side, left = column == 0, right = column + 1 == side;
    if ((top && left) || (bottom && right)) return CellKind::kMain;
    if ((top && right) || (bottom && left)) return CellKind::kAnti;
    return CellKind::kShorter;
}

GridGluing glue(const QuadComplex& complex, const std::vector<uint32_t>& sample_at, uint32_t side) {
    const TileSamples samples(complex, side);
    const TileAtlas atlas(complex.tiles, side);
    const std::vector<bool> boundary = boundary_samples(complex, samples, side);
    GluedSamples glued;
    glued.width = atlas.width();
    glued.height = atlas.height();
    glued.defined.resize(sample_at.size());
    glued.on_input_boundary.resize(sample_at.size());
    glued.classes.resize(samples.count());
    for (uint32_t texel = 0; texel < sample_at.size(); ++texel) {
        if (sample_at[texel] == kNone) continue;
        glued.defined[texel] = 1;
        glued.on_input_boundary[texel] = boundary[sample_at[texel]];
        glued.classes[sample_at[texel]].push_back(texel);
    }
    glued.kind.assign(size_t{glued.width - 1} * (glued.height - 1), CellKind::kEmpty);
    for (uint32_t tile = 0; tile < complex.tiles; ++tile) {
        for (uint32_t row = 0; row < side; ++row) {
            const size_t first = size_t{atlas.row(tile) + row} * (glued.width - 1) + atlas.column(tile);
            for (uint32_t column = 0; column < side; ++column) glued.kind[first + column] = split_of(row, column, side);
        }
    }
    return make_gluing(std::move(glued));
}

}  // namespace

TileImage sample_tiles(const std::vector<Vec3>& positions, const TileMap& map, const std::vector<SurfacePoint>& points,
                       uint32_t exponent) {
    NumberedQuads numbered = number_quads(map.quads);
    TileImage image;
    image.quads = std::move(numbered.quads);
    image.vertices = static_cast<uint32_t>(numbered.vertices.size());
    image.exponent = exponent;
    for (const SurfacePoint& point : points) {
        const Triangle& t = map.triangles[point.triangle];
        Vec3 p = Vec3::Zero();
        for (size_t k = 0; k < 3; ++k) p += point.barycentric[k] * positions[t[k]];
        image.positions.push_back(p);
    }
    return image;
}

Result<std::vector<uint32_t>> samples_of_atlas(const TileImage& tiles) {
    GIM_TRY(complex, complex_of(tiles.quads, tiles.vertices));
    return texels(complex.view(), 1u << tiles.exponent);
}

Result<GeometryImage> atlas_of(const TileImage& tiles) {
    GIM_TRY(complex, complex_of(tiles.quads, tiles.vertices));
    const uint32_t side = 1u << tiles.exponent;
    const std::vector<uint32_t> sample_at = texels(complex.view(), side);
    GeometryImage image;
    image.gluing = glue(complex.view(), sample_at, side);
    for (const uint32_t sample : sample_at)
        image.positions.push_back(sample == kNone ? Vec3(Vec3::Zero()) : tiles.positions[sample]);
    return image;
}

}  // namespace gim
