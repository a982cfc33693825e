#include "encoder/image/gluing.h"

#include <algorithm>
#include <numeric>

#include "encoder/base/parallel.h"

namespace gim {

namespace {

// Adds a class of samples that are one surface point, in any order. Ignores a single sample.
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

// Finds the edges of the surface along rows and columns. A side of a cell is an edge if a triangle of the cell has it
// and its ends are two surface points.
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

// main: whether a kShorter cell is split along the main diagonal.
CellTriangles triangles_of_cell(CellKind kind, uint32_t first, uint32_t width, bool main) {
    const uint32_t a = first, b = first + 1, c = first + width + 1, d = first + width;
    switch (kind) {
        case CellKind::kEmpty:
            return {};
        case CellKind::kNoFirst:
            return {{{{b, c, d}, {}}}, 1};
        case CellKind::kNoSecond:
            return {{{{a, c, d}, {}}}, 1};
        case CellKind::kNoThird:
            return {{{{a, b, d}, {}}}, 1};
        case CellKind::kNoFourth:
            return {{{{a, b, c}, {}}}, 1};
        default:
            break;
    }
    if (kind == CellKind::kMain || (kind == CellKind::kShorter && main)) return {{{{a, b, c}, {a, c, d}}}, 2};
    return {{{{a, b, d}, {b, c, d}}}, 2};
}

}  // namespace

CellKind kind_of(Split split) {
    if (split == Split::kMain) return CellKind::kMain;
    return split == Split::kAnti ? CellKind::kAnti : CellKind::kShorter;
}

uint64_t GridGluing::defined_count() const {
    return static_cast<uint64_t>(
        std::count_if(representative.begin(), representative.end(), [](uint32_t v) { return v != kNone; }));
}

GridGluing make_gluing(GluedSamples samples) {
    const size_t count = size_t{samples.width} * samples.height;
    GridGluing gluing;
    gluing.width = samples.width;
    gluing.height = samples.height;
    gluing.representative.resize(count);
    std::iota(gluing.representative.begin(), gluing.representative.end(), 0u);
    for (size_t v = 0; v < samples.defined.size(); ++v) {
        if (!samples.defined[v]) gluing.representative[v] = kNone;
    }
    gluing.class_of.assign(count, kNone);
    gluing.on_input_boundary = std::move(samples.on_input_boundary);
    for (std::vector<uint32_t>& glued : samples.classes) add_class(std::move(glued), gluing);
    gluing.kind = std::move(samples.kind);
    find_edges(gluing);
    return gluing;
}

CellTriangles cell_triangles(const std::vector<Vec3>& positions, const GridGluing& gluing, uint32_t cell) {
    const auto [a, b, c, d] = gluing.corners(cell);
    const bool main = gluing.kind[cell] == CellKind::kShorter &&
                      (positions[a] - positions[d]).squaredNorm() <= (positions[b] - positions[c]).squaredNorm();
    return triangles_of_cell(gluing.kind[cell], a, gluing.width, main);
}

std::array<Triangle, 2> split_cell(const std::vector<Vec3>& positions, const GridGluing& gluing, uint32_t cell) {
    const CellTriangles all = cell_triangles(positions, gluing, cell);
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
