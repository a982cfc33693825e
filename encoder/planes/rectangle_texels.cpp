#include "encoder/planes/rectangle_texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "encoder/surface/stretch.h"
#include "format/plane_code.h"

namespace gim {

namespace {

// A triangle of a cell. Its corners are in samples, relative to the cell's first sample.
struct PlaneTriangle {
    const GeometryImage& image;
    const std::vector<Vec3>& outside;
    Triangle samples;
    std::array<Vec2, 3> corner;

    // Returns the texel at a point, or nothing if the point lies outside. Exact: coordinates are multiples of 2^-k.
    std::optional<Texel> at(const Vec2& p) const {
        const double area = twice_signed_area(corner[0], corner[1], corner[2]);
        const std::array<double, 3> w{twice_signed_area(p, corner[1], corner[2]) / area,
                                      twice_signed_area(corner[0], p, corner[2]) / area,
                                      twice_signed_area(corner[0], corner[1], p) / area};
        if (std::min({w[0], w[1], w[2]}) < 0) return std::nullopt;
        Texel texel;
        for (size_t k = 0; k < 3; ++k) {
            const Vec3 &here = image.positions[samples[k]], &next = image.positions[samples[(k + 1) % 3]];
            texel.position += w[k] * here;
            texel.outside += w[k] * outside[samples[k]];
            texel.spacing = std::max(texel.spacing, (here - next).norm());
        }
        texel.outside = unit_or_zero(texel.outside);
        return texel;
    }
};

}  // namespace

uint8_t texel_exponent(double per_sample) {
    return static_cast<uint8_t>(
        std::clamp(std::lround(std::log2(per_sample)), 0l, static_cast<long>(kMaxTexelExponent)));
}

TexelGrid rectangle_texels(const GeometryImage& image, uint8_t exponent) {
    const uint32_t width = image.width(), per_sample = 1u << exponent;
    const std::vector<Vec3> outside = outside_directions(image);
    TexelGrid grid;
    grid.columns = static_cast<uint32_t>(texels_along(width, exponent));
    grid.rows = static_cast<uint32_t>(texels_along(image.height(), exponent));
    std::vector<bool> taken(size_t{grid.columns} * grid.rows, false);
    for (uint32_t cell = 0; cell < image.gluing.kind.size(); ++cell) {
        const uint32_t row = cell / (width - 1), column = cell % (width - 1);
        const CellTriangles all = cell_triangles(image.positions, image.gluing, cell);
        for (uint32_t k = 0; k < all.count; ++k) {
            PlaneTriangle triangle{image, outside, all.triangles[k], {}};
            for (size_t c = 0; c < 3; ++c) {
                const uint32_t sample = triangle.samples[c];
                triangle.corner[c] = Vec2(sample % width - column, sample / width - row);
            }
            for (uint32_t i = 0; i <= per_sample; ++i) {
                for (uint32_t j = 0; j <= per_sample; ++j) {
                    const uint32_t index = (row * per_sample + i) * grid.columns + column * per_sample + j;
                    if (taken[index]) continue;
                    auto texel = triangle.at(Vec2(j, i) / per_sample);
                    if (!texel) continue;
                    taken[index] = true;
                    texel->index = index;
                    grid.texels.push_back(*texel);
                }
            }
        }
    }
    return grid;
}

}  // namespace gim
