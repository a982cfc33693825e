#include "encoder/squares/square_image.h"

#include <memory>
#include <string>
#include <utility>

#include "format/ring.h"
#include "format/seam.h"

namespace gim {

namespace {

Error bad_seams(const std::string& why) { return Error{Stage::kFit, "the image's seams are inconsistent: " + why}; }

// Returns the samples of the ring, in ring order.
std::vector<uint32_t> ring_samples(uint32_t side) {
    std::vector<uint32_t> samples(ring_length(side));
    for (uint32_t k = 0; k < samples.size(); ++k) {
        const GridPoint at = ring_point(side, k);
        samples[k] = at.row * side + at.column;
    }
    return samples;
}

void mark_boundary(const SeamTable& table, uint32_t side, const std::vector<uint32_t>& ring,
                   std::vector<bool>& marked) {
    if (table.path_count == 0) {
        for (const uint32_t v : ring) marked[v] = true;
        return;
    }
    const uint32_t unit = (side - 1) / (table.node_side - 1);
    for (uint32_t p = 0; p < table.path_count; ++p) {
        if (table.mate[p] != kNoMate) continue;
        for (uint32_t k = table.first[p] * unit; k <= table.first[p + 1] * unit; ++k)
            marked[ring[k % ring.size()]] = true;
    }
}

}  // namespace

Result<GridGluing> glue_ring(const Sideband& sideband, uint32_t side) {
    const auto table = std::make_unique<SeamTable>();
    if (build_seam_table(sideband, table.get()) != Status::kOk)
        return bad_seams("the paths do not fill the ring in pairs");
    if (!is_grid_side(side) || side < table->node_side) return bad_seams("the node grid is finer than the image");

    GluedSamples samples;
    samples.width = samples.height = side;
    samples.on_input_boundary.assign(size_t{side} * side, false);
    const std::vector<uint32_t> ring = ring_samples(side);
    mark_boundary(*table, side, ring, samples.on_input_boundary);
    std::vector<uint32_t> class_at(ring.size());
    ring_classes(*table, side, class_at);
    samples.classes.resize(ring.size());
    for (size_t k = 0; k < ring.size(); ++k) samples.classes[class_at[k]].push_back(ring[k]);

    const uint32_t cells = side - 1;
    samples.kind.assign(size_t{cells} * cells, CellKind::kShorter);
    for (uint32_t row = 0; row < cells; ++row) {
        const bool row_end = row == 0 || row == cells - 1;
        for (uint32_t column = 0; column < cells; column += row_end || cells < 2 ? 1 : cells - 1) {
            const auto at = [&](uint32_t k) { return class_at[k]; };
            samples.kind[size_t{row} * cells + column] = kind_of(rim_split(side, row, column, at));
        }
    }
    return make_gluing(std::move(samples));
}

Result<SquareImage> glue_square(SquareGrid grid, Sideband sideband) {
    if (grid.positions.size() != size_t{grid.side} * grid.side)
        return bad_seams(std::to_string(grid.positions.size()) + " positions for a side of " +
                         std::to_string(grid.side));
    GIM_TRY(gluing, glue_ring(sideband, grid.side));
    SquareImage image;
    image.positions = std::move(grid.positions);
    image.gluing = std::move(gluing);
    image.sideband = std::move(sideband);
    return image;
}

}  // namespace gim
