// A grid of samples as a triangle surface (grid_surface.h). Cost O(samples).
#include "encoder/image/gluing.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <string>

#include "encoder/base/parallel.h"
#include "encoder/base/result.h"
#include "format/seam.h"

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

// Samples that are one surface point, in any order; nothing for a single one.
void add_class(std::vector<uint32_t> glued, GridGluing& gluing) {
    if (glued.size() < 2) return;
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

CellKind kind_of(Split split) {
    if (split == Split::kMain) return CellKind::kMain;
    return split == Split::kAnti ? CellKind::kAnti : CellKind::kShorter;
}

// Rows and columns of a cell's sides are edges of the surface where a triangle of the cell has them and their ends are
// two points.
void find_edges(GridGluing& gluing) {
    gluing.edges.assign(gluing.sample_count(), 0);
    const auto join = [&](uint32_t first, uint32_t second, GridGluing::Edge to_second, GridGluing::Edge to_first) {
        if (gluing.representative[first] == gluing.representative[second]) return;
        gluing.edges[first] |= to_second;
        gluing.edges[second] |= to_first;
    };
    for (uint32_t cell = 0; cell < gluing.kind.size(); ++cell) {
        const CellKind kind = gluing.kind[cell];
        if (kind == CellKind::kEmpty) continue;
        const auto [a, b, c, d] = gluing.corners(cell);
        const bool has_a = kind != CellKind::kNoFirst, has_b = kind != CellKind::kNoSecond;
        const bool has_d = kind != CellKind::kNoThird, has_c = kind != CellKind::kNoFourth;
        if (has_a && has_b) join(a, b, GridGluing::kEast, GridGluing::kWest);
        if (has_c && has_d) join(c, d, GridGluing::kEast, GridGluing::kWest);
        if (has_a && has_c) join(a, c, GridGluing::kSouth, GridGluing::kNorth);
        if (has_b && has_d) join(b, d, GridGluing::kSouth, GridGluing::kNorth);
    }
}

}  // namespace

uint64_t GridGluing::defined_count() const {
    return static_cast<uint64_t>(
        std::count_if(representative.begin(), representative.end(), [](uint32_t v) { return v != kNone; }));
}

Result<GridGluing> glue_ring(const Sideband& sideband, uint32_t side) {
    const auto table = std::make_unique<SeamTable>();
    if (build_seam_table(sideband, table.get()) != Status::kOk)
        return bad_seams("the paths do not fill the ring in pairs");
    if (!is_grid_side(side) || side < table->node_side) return bad_seams("the node grid is finer than the image");

    const size_t samples = size_t{side} * side;
    GridGluing gluing;
    gluing.width = gluing.height = side;
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
    for (std::vector<uint32_t>& glued : members) add_class(std::move(glued), gluing);

    const uint32_t cells = side - 1;
    gluing.kind.assign(size_t{cells} * cells, CellKind::kShorter);
    for (uint32_t row = 0; row < cells; ++row) {
        const bool row_end = row == 0 || row == cells - 1;
        for (uint32_t column = 0; column < cells; column += row_end || cells < 2 ? 1 : cells - 1) {
            const auto at = [&](uint32_t k) { return class_at[k]; };
            gluing.kind[size_t{row} * cells + column] = kind_of(rim_split(side, row, column, at));
        }
    }
    find_edges(gluing);
    return gluing;
}

Result<GridGluing> glue_charts(const SampleMask& mask, const SeamRecord& seams) {
    GridGluing gluing;
    gluing.width = mask.width;
    gluing.height = mask.height;
    GIM_TRY(point, glue_samples(mask, seams));
    gluing.representative = std::move(point);
    const size_t samples = gluing.sample_count();
    gluing.class_of.assign(samples, kNone);
    gluing.on_input_boundary.assign(samples, false);
    GIM_TRY(paths, path_samples(mask, seams));
    for (size_t p = 0; p < paths.size(); ++p) {
        if (seams.paths[p].mate != kNone) continue;
        for (const uint32_t v : paths[p]) gluing.on_input_boundary[v] = true;
    }
    std::vector<std::vector<uint32_t>> members(samples);
    for (uint32_t v = 0; v < samples; ++v) {
        if (gluing.is_defined(v)) members[gluing.representative[v]].push_back(v);
    }
    for (std::vector<uint32_t>& glued : members) add_class(std::move(glued), gluing);
    gluing.kind = classify_cells(mask, gluing.representative);
    find_edges(gluing);
    return gluing;
}

std::array<Triangle, 2> split_cell(const std::vector<Vec3>& positions, const GridGluing& gluing, uint32_t cell) {
    const auto [a, b, c, d] = gluing.corners(cell);
    const bool main = gluing.kind[cell] == CellKind::kShorter &&
                      (positions[a] - positions[d]).squaredNorm() <= (positions[b] - positions[c]).squaredNorm();
    const CellTriangles all = triangles_of_cell(gluing.kind[cell], a, gluing.width, main);
    std::array<Triangle, 2> result{kNoFace, kNoFace};
    for (uint32_t k = 0; k < all.count; ++k) {
        const auto point = [&](size_t i) { return gluing.representative[all.triangles[k][i]]; };
        if (point(0) != point(1) && point(1) != point(2) && point(2) != point(0)) result[k] = all.triangles[k];
    }
    return result;
}

GridFaces triangulate_grid(const std::vector<Vec3>& positions, const GridGluing& gluing) {
    std::vector<Triangle> in_slot(2 * gluing.kind.size());
    parallel_blocks(gluing.kind.size(), 4096, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t cell = begin; cell < end; ++cell) {
            const auto halves = split_cell(positions, gluing, static_cast<uint32_t>(cell));
            in_slot[2 * cell] = halves[0];
            in_slot[2 * cell + 1] = halves[1];
        }
    });
    GridFaces faces;
    faces.triangles.reserve(in_slot.size());
    faces.slot.reserve(in_slot.size());
    for (uint32_t slot = 0; slot < in_slot.size(); ++slot) {
        if (in_slot[slot] == kNoFace) continue;
        faces.triangles.push_back(in_slot[slot]);
        faces.slot.push_back(slot);
    }
    return faces;
}

}  // namespace gim
