#include "encoder/squares/square_texels.h"

#include <algorithm>
#include <bit>

#include "encoder/base/parallel.h"
#include "format/cell.h"
#include "format/sideband_code.h"

namespace gim {

namespace {

constexpr size_t kBlock = 4096;

int exponent_of(uint32_t side) { return std::countr_zero(side - 1); }

// Interpolates linearly within a triangle of the cell. `row` and `column` are in 0 .. side-1.
Texel texel_at(const SquareImage& image, const std::vector<Vec3>& outside, double row, double column) {
    const CellPoint place = locate_in_cell(image.side(), row, column);
    const auto& [a, b, c, d] = place.corners;
    const bool main = split_cell(image.positions, image.gluing, place.cell)[0][2] == d;
    const std::array<double, 4> w = place.weights(main);
    Texel texel;
    for (size_t i = 0; i < 4; ++i) {
        texel.position += w[i] * image.positions[place.corners[i]];
        texel.outside += w[i] * outside[place.corners[i]];
    }
    texel.outside = unit_or_zero(texel.outside);
    // The cell's longer diagonal.
    texel.spacing =
        std::max((image.positions[a] - image.positions[d]).norm(), (image.positions[b] - image.positions[c]).norm());
    return texel;
}

}  // namespace

std::vector<uint8_t> square_plane_exponents(std::span<const SquareImage> images, uint32_t side) {
    uint32_t largest = 0;
    for (const SquareImage& image : images) largest = std::max(largest, image.side());
    std::vector<uint8_t> exponents;
    for (const SquareImage& image : images) {
        const int wanted = exponent_of(side) + exponent_of(image.side()) - exponent_of(largest);
        const uint32_t nodes = with_coarsest_node_grid(image.sideband).node_side;
        exponents.push_back(static_cast<uint8_t>(std::max({wanted, 1, exponent_of(std::max(nodes, 3u))})));
    }
    return exponents;
}

TexelGrid square_texels(const SquareImage& image, uint32_t side) {
    const std::vector<Vec3> outside = outside_directions(image);
    const double scale = double(image.side() - 1) / (side - 1);
    TexelGrid grid{side, side, std::vector<Texel>(size_t{side} * side)};
    parallel_blocks(grid.texels.size(), kBlock, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const size_t row = i / side, column = i % side;
            grid.texels[i] = texel_at(image, outside, double(row) * scale, double(column) * scale);
            grid.texels[i].index = static_cast<uint32_t>(i);
        }
    });
    return grid;
}

void equalize_ring(const Sideband& sideband, uint32_t side, std::vector<float>& values) {
    const auto gluing = glue_ring(with_coarsest_node_grid(sideband), side);
    if (!gluing.ok()) return;
    const std::vector<uint32_t>& representative = gluing.value().representative;
    for (size_t i = 0; i < representative.size(); ++i) {
        const size_t from = representative[i];
        if (from != i)
            std::copy_n(values.begin() + static_cast<ptrdiff_t>(3 * from), 3,
                        values.begin() + static_cast<ptrdiff_t>(3 * i));
    }
}

}  // namespace gim
