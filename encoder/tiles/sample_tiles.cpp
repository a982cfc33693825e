#include "encoder/tiles/sample_tiles.h"

#include <algorithm>
#include <cmath>

namespace gim {

namespace {

// Calls visit(texel of the atlas, sample) for every sample of every tile.
template <class Visit>
void for_each_texel(const QuadComplex& complex, const TileAtlas& atlas, const Visit& visit) {
    const TileSamples samples(complex, atlas.side);
    for (uint32_t tile = 0; tile < complex.tiles; ++tile) {
        for (uint32_t row = 0; row <= atlas.side; ++row) {
            for (uint32_t column = 0; column <= atlas.side; ++column)
                visit(atlas.at(tile, row, column), samples.at(tile, row, column));
        }
    }
}

// Per sample: whether it lies on a boundary of the complex.
std::vector<bool> boundary_samples(const QuadComplex& complex, uint32_t side) {
    const TileSamples samples(complex, side);
    std::vector<bool> boundary(samples.count(), false);
    for (uint32_t h = 0; h < complex.half_edges(); ++h) {
        if (complex.mate[h] != kNoMate) continue;
        for (uint32_t t = 0; t <= side; ++t) boundary[samples.along(h, t)] = true;
    }
    return boundary;
}

}  // namespace

// Takes the fewest empty slots among rectangles up to three times as long as wide, then the squarest.
TileAtlas make_atlas(uint32_t tiles, uint32_t side) {
    const auto root = static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(tiles))));
    TileAtlas best{root, (tiles + root - 1) / root, side};
    for (uint32_t rows = root; rows > 0; --rows) {
        const uint32_t columns = (tiles + rows - 1) / rows;
        if (columns > 3 * rows) break;
        if (columns * rows < best.columns * best.rows) best = {columns, rows, side};
    }
    return best;
}

GridGluing glue_tiles(TileComplex& complex, const TileAtlas& atlas) {
    const QuadComplex view = complex.view();
    GluedSamples glued;
    glued.width = atlas.width();
    glued.height = atlas.height();
    glued.defined.assign(size_t{glued.width} * glued.height, 0);
    glued.on_input_boundary.assign(glued.defined.size(), false);
    glued.classes.resize(TileSamples(view, atlas.side).count());
    glued.kind.assign(size_t{glued.width - 1} * (glued.height - 1), CellKind::kEmpty);
    const std::vector<bool> boundary = boundary_samples(view, atlas.side);
    for_each_texel(view, atlas, [&](uint32_t texel, uint32_t sample) {
        glued.defined[texel] = 1;
        glued.on_input_boundary[texel] = boundary[sample];
        glued.classes[sample].push_back(texel);
    });
    for (uint32_t tile = 0; tile < view.tiles; ++tile) {
        for (uint32_t row = 0; row < atlas.side; ++row) {
            const uint32_t first = atlas.at(tile, row, 0);
            const auto cell = glued.kind.begin() + (first - first / glued.width);
            std::fill_n(cell, atlas.side, CellKind::kShorter);
        }
    }
    return make_gluing(std::move(glued));
}

GeometryImage sample_tiles(const std::vector<Vec3>& positions, const TileMap& map, TileComplex& complex,
                           const std::vector<SurfacePoint>& points, uint32_t side) {
    const TileAtlas atlas = make_atlas(static_cast<uint32_t>(map.quads.size()), side);
    GeometryImage image;
    image.gluing = glue_tiles(complex, atlas);
    image.positions.assign(image.gluing.sample_count(), Vec3::Zero());
    std::vector<Vec3> at(points.size(), Vec3::Zero());
    for (size_t i = 0; i < points.size(); ++i) {
        const Triangle& t = map.triangles[points[i].triangle];
        for (size_t k = 0; k < 3; ++k) at[i] += points[i].barycentric[k] * positions[t[k]];
    }
    for_each_texel(complex.view(), atlas,
                   [&](uint32_t texel, uint32_t sample) { image.positions[texel] = at[sample]; });
    return image;
}

}  // namespace gim
