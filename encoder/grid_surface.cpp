// A geometry image as a triangle surface (grid_surface.h). Cost O(samples).
#include "encoder/grid_surface.h"

#include <algorithm>
#include <string>

#include "encoder/disjoint_sets.h"
#include "encoder/parallel.h"

namespace gim {

namespace {

// Ring sample k of a square, as a sample index (format/sideband.h defines the order).
uint32_t ring_sample(uint32_t side, uint32_t k) {
    const uint32_t last = side - 1;
    if (k < last) return k;
    if (k < 2 * last) return (k - last) * side + last;
    if (k < 3 * last) return last * side + (3 * last - k);
    return (4 * last - k) * side;
}

Error bad_sideband(const std::string& why) { return Error{Stage::kFit, "the image's seams are inconsistent: " + why}; }

}  // namespace

Result<RingGluing> glue_ring(const Sideband& sideband, uint32_t side) {
    const size_t samples = size_t{side} * side;
    RingGluing gluing;
    gluing.representative.resize(samples);
    gluing.on_input_boundary.assign(samples, false);
    gluing.class_of.assign(samples, kNone);
    for (uint32_t v = 0; v < samples; ++v) gluing.representative[v] = v;

    const uint32_t ring = 4 * (side - 1);
    if (sideband.paths.empty()) {
        for (uint32_t k = 0; k < ring; ++k) gluing.on_input_boundary[ring_sample(side, k)] = true;
        return gluing;
    }
    if (sideband.node_side < 2 || (side - 1) % (sideband.node_side - 1) != 0) {
        return bad_sideband("the node grid does not divide the image");
    }
    const uint32_t unit = (side - 1) / (sideband.node_side - 1);
    std::vector<uint32_t> first(sideband.paths.size() + 1, sideband.start * unit);
    for (size_t p = 0; p < sideband.paths.size(); ++p) first[p + 1] = first[p] + sideband.paths[p].length * unit;
    if (first.back() - first.front() != ring) return bad_sideband("the paths do not fill the ring");

    DisjointSets same(samples);
    for (size_t p = 0; p < sideband.paths.size(); ++p) {
        const CutPath& path = sideband.paths[p];
        const uint32_t length = path.length * unit;
        if (path.mate == kNoMate) {
            for (uint32_t k = 0; k <= length; ++k)
                gluing.on_input_boundary[ring_sample(side, (first[p] + k) % ring)] = true;
            continue;
        }
        if (path.mate < 0 || static_cast<size_t>(path.mate) >= sideband.paths.size() ||
            sideband.paths[path.mate].length != path.length) {
            return bad_sideband("path " + std::to_string(p) + " and its mate differ");
        }
        const uint32_t mate_end = first[path.mate] + length;
        for (uint32_t k = 0; k <= length; ++k) {
            same.unite(ring_sample(side, (first[p] + k) % ring), ring_sample(side, (mate_end - k) % ring));
        }
    }
    std::vector<std::vector<uint32_t>> members(samples);
    std::vector<uint32_t> ring_samples(ring);
    for (uint32_t k = 0; k < ring; ++k) ring_samples[k] = ring_sample(side, k);
    std::sort(ring_samples.begin(), ring_samples.end());
    for (const uint32_t v : ring_samples) {
        gluing.representative[v] = same.find(v);
        members[gluing.representative[v]].push_back(v);
    }
    for (const uint32_t v : ring_samples) {
        if (members[v].size() < 2) continue;
        bool boundary = false;
        for (const uint32_t member : members[v]) boundary = boundary || gluing.on_input_boundary[member];
        for (const uint32_t member : members[v]) {
            gluing.on_input_boundary[member] = boundary;
            gluing.class_of[member] = static_cast<uint32_t>(gluing.shared.size());
        }
        gluing.shared.push_back(std::move(members[v]));
    }
    return gluing;
}

std::array<Triangle, 2> split_cell(const std::vector<Vec3>& positions, uint32_t side, const RingGluing&,
                                   uint32_t cell) {
    const uint32_t last = side - 2, row = cell / (side - 1), column = cell % (side - 1);
    const uint32_t a = row * side + column, b = a + 1, c = a + side, d = c + 1;
    bool main = (positions[a] - positions[d]).squaredNorm() <= (positions[b] - positions[c]).squaredNorm();
    // A diagonal that cuts a corner of the square off would join two samples of the ring.
    if ((row == 0 || row == last) && (column == 0 || column == last)) main = (row == 0) == (column == 0);
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
