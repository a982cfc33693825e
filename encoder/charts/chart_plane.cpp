#include "encoder/charts/chart_plane.h"

#include <utility>

#include "encoder/code/extend_chart.h"
#include "format/chart_table.h"

namespace gim {

namespace {

constexpr int kRounds = 12;  // of the extension

}  // namespace

Pyramid<float> analyse_chart_plane(const TexelGrid& grid, std::vector<float> values, float quantizer) {
    std::vector<uint8_t> defined(size_t{grid.columns} * grid.rows, 0);
    for (const Texel& texel : grid.texels) defined[texel.index] = 1;
    const uint32_t steps = halvings(grid.columns, grid.rows);
    values =
        extend_chart<Irreversible97>(std::move(values), defined, grid.columns, grid.rows, steps, quantizer, kRounds);
    return analyse<Irreversible97>(std::move(values), grid.columns, grid.rows, steps);
}

}  // namespace gim
