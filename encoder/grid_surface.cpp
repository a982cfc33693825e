// A geometry image as a triangle surface (grid_surface.h). Cost O(samples).
#include "encoder/grid_surface.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <string>

#include "encoder/parallel.h"

namespace gim {

namespace {

Error bad_seams(const std::string& why) { return Error{Stage::kFit, "the image's seams are inconsistent: " + why}; }

// Samples of the ring, in ring order.
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
        if (table.mate[p] != SeamTable::kBoundary) continue;
        for (uint32_t k = table.first[p] * unit; k <= table.first[p + 1] * unit; ++k)
            marked[ring[k % ring.size()]] = true;
    }
}

}  // namespace

Result<RingGluing> glue_ring(const Sideband& sideband, uint32_t side) {
    const auto table = std::make_unique<SeamTable>();
    if (build_seam_table(sideband, table.get()) != Status::kOk)
        return bad_seams("the paths do not fill the ring in pairs");
    if (!is_grid_side(side) || side < table->node_side) return bad_seams("the node grid is finer than the image");

    const size_t samples = size_t{side} * side;
    RingGluing gluing;
    gluing.representative.resize(samples);
    std::iota(gluing.representative.begin(), gluing.representative.end(), 0u);
    gluing.class_of.assign(samples, kNone);
    gluing.on_input_boundary.assign(samples, false);

    const std::vector<uint32_t> ring = ring_samples(side);
    mark_boundary(*table, side, ring, gluing.on_input_boundary);
    std::vector<uint32_t> class_at(ring.size());
    ring_classes(*table, side, class_at);
    std::vector<std::vector<uint32_t>> members(ring.size());
    for (size_t k = 0; k < ring.size(); ++k) members[class_at[k]].push_back(ring[k]);
    for (std::vector<uint32_t>& glued : members) {
        if (glued.size() < 2) continue;
        std::sort(glued.begin(), glued.end());
        const bool boundary =
            std::any_of(glued.begin(), glued.end(), [&](uint32_t v) { return gluing.on_input_boundary[v]; });
        for (const uint32_t v : glued) {
            gluing.representative[v] = glued.front();
            gluing.class_of[v] = static_cast<uint32_t>(gluing.shared.size());
            gluing.on_input_boundary[v] = boundary;
        }
        gluing.shared.push_back(std::move(glued));
    }

    const uint32_t cells = side - 1;
    gluing.split.assign(size_t{cells} * cells, Split::kShorter);
    for (uint32_t row = 0; row < cells; ++row) {
        const bool row_end = row == 0 || row == cells - 1;
        for (uint32_t column = 0; column < cells; column += row_end || cells < 2 ? 1 : cells - 1) {
            const auto at = [&](uint32_t k) { return class_at[k]; };
            gluing.split[size_t{row} * cells + column] = rim_split(side, row, column, at);
        }
    }
    return gluing;
}

std::array<Triangle, 2> split_cell(const std::vector<Vec3>& positions, uint32_t side, const RingGluing& gluing,
                                   uint32_t cell) {
    const uint32_t a = cell / (side - 1) * side + cell % (side - 1), b = a + 1, c = a + side, d = c + 1;
    const bool shorter_main =
        (positions[a] - positions[d]).squaredNorm() <= (positions[b] - positions[c]).squaredNorm();
    const bool main = gluing.split[cell] == Split::kMain || (gluing.split[cell] != Split::kAnti && shorter_main);
    if (main) return {Triangle{a, b, d}, Triangle{a, d, c}};
    return {Triangle{a, b, c}, Triangle{b, d, c}};
}

std::vector<Triangle> triangulate_grid(const std::vector<Vec3>& positions, uint32_t side, const RingGluing& gluing) {
    const size_t cells = size_t{side - 1} * (side - 1);
    std::vector<Triangle> triangles(2 * cells);
    parallel_blocks(cells, 4096, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t cell = begin; cell < end; ++cell) {
            const auto halves = split_cell(positions, side, gluing, static_cast<uint32_t>(cell));
            triangles[2 * cell] = halves[0];
            triangles[2 * cell + 1] = halves[1];
        }
    });
    return triangles;
}

}  // namespace gim
