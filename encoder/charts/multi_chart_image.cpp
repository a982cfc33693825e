#include "encoder/charts/multi_chart_image.h"

#include <algorithm>
#include <string>

#include "encoder/base/disjoint_sets.h"
#include "encoder/base/result.h"
#include "format/chart_split.h"

namespace gim {

namespace {

Error misfit(const std::string& what) { return {Stage::kSample, "the seam record does not fit the mask: " + what}; }

// What chart_split asks of a mask.
struct MaskGrid {
    const SampleMask& mask;
    const std::vector<uint8_t>& border;
    const std::vector<uint32_t>& points;

    size_t index(uint32_t row, uint32_t column) const { return size_t{row} * mask.width + column; }
    bool on_border(uint32_t row, uint32_t column) const { return border[index(row, column)] != 0; }
    uint32_t point(uint32_t row, uint32_t column) const { return points[index(row, column)]; }
};

}  // namespace

Result<std::vector<std::vector<uint32_t>>> path_samples(const SampleMask& mask, const SeamRecord& seams) {
    const std::vector<std::vector<uint32_t>> loops = trace_borders(mask);
    if (loops.size() != seams.loops.size()) return misfit("another number of charts");
    struct Place {
        uint32_t loop = kNone, index = 0;
    };
    std::vector<Place> place(mask.defined.size());
    for (uint32_t l = 0; l < loops.size(); ++l) {
        for (uint32_t i = 0; i < loops[l].size(); ++i) place[loops[l][i]] = {l, i};
    }
    std::vector<uint8_t> used(loops.size(), 0);
    std::vector<std::vector<uint32_t>> samples;
    for (const SeamRecord::Loop& chart : seams.loops) {
        if (chart.start >= place.size() || place[chart.start].loop == kNone || chart.path_count == 0)
            return misfit("a chart without a first path");
        const std::vector<uint32_t>& loop = loops[place[chart.start].loop];
        if (used[place[chart.start].loop]++) return misfit("two charts with one border");
        size_t at = place[chart.start].index, total = 0;
        for (uint32_t k = 0; k < chart.path_count; ++k) {
            if (samples.size() == seams.paths.size()) return misfit("too few paths");
            const uint32_t length = seams.paths[samples.size()].length;
            total += length;
            if (length == 0 || total > loop.size()) return misfit("paths longer than their border");
            samples.emplace_back();
            for (uint32_t i = 0; i <= length; ++i) samples.back().push_back(loop[(at + i) % loop.size()]);
            at += length;
        }
        if (total != loop.size()) return misfit("paths shorter than their border");
    }
    if (samples.size() != seams.paths.size()) return misfit("too many paths");
    return samples;
}

Result<std::vector<uint32_t>> glue_samples(const SampleMask& mask, const SeamRecord& seams) {
    GIM_TRY(samples, path_samples(mask, seams));
    DisjointSets sets(mask.defined.size());
    size_t zipper = 0;
    for (uint32_t p = 0; p < seams.paths.size(); ++p) {
        const uint32_t mate = seams.paths[p].mate;
        if (mate == kNone) continue;
        if (mate >= seams.paths.size() || mate == p || seams.paths[mate].mate != p) return misfit("one-sided mates");
        if (mate < p) continue;
        if (zipper == seams.zippers.size()) return misfit("too few zippers");
        size_t i = 0, j = seams.paths[mate].length;
        sets.unite(samples[p][i], samples[mate][j]);
        for (const ZipStep step : seams.zippers[zipper++]) {
            if (step != ZipStep::kSecond && ++i > seams.paths[p].length) return misfit("a zipper runs past its path");
            if (step != ZipStep::kFirst && j-- == 0) return misfit("a zipper runs past its mate");
            sets.unite(samples[p][i], samples[mate][j]);
        }
        if (i != seams.paths[p].length || j != 0) return misfit("a zipper ends early");
    }
    if (zipper != seams.zippers.size()) return misfit("too many zippers");
    std::vector<uint32_t> representative(mask.defined.size(), kNone);
    for (uint32_t i = 0; i < representative.size(); ++i) {
        if (mask.defined[i]) representative[i] = sets.find(i);
    }
    return representative;
}

std::vector<CellKind> classify_cells(const SampleMask& mask, const std::vector<uint32_t>& point) {
    std::vector<uint8_t> border(mask.defined.size(), 0);
    for (const auto& loop : trace_borders(mask)) {
        for (const uint32_t i : loop) border[i] = 1;
    }
    const MaskGrid grid{mask, border, point};
    std::vector<CellKind> kinds;
    kinds.reserve(size_t{mask.width - 1} * (mask.height - 1));
    for (uint32_t row = 0; row + 1 < mask.height; ++row) {
        for (uint32_t column = 0; column + 1 < mask.width; ++column) {
            const bool first = mask.at(column, row), second = mask.at(column + 1, row),
                       third = mask.at(column + 1, row + 1), fourth = mask.at(column, row + 1);
            const int count = first + second + third + fourth;
            CellKind kind = CellKind::kEmpty;
            if (count == 3) {
                kind = !first    ? CellKind::kNoFirst
                       : !second ? CellKind::kNoSecond
                       : !third  ? CellKind::kNoThird
                                 : CellKind::kNoFourth;
            } else if (count == 4) {
                const Split split = chart_split(grid, row, column);
                kind = split == Split::kShorter ? CellKind::kShorter
                       : split == Split::kMain  ? CellKind::kMain
                                                : CellKind::kAnti;
            }
            kinds.push_back(kind);
        }
    }
    return kinds;
}

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

std::vector<CellTriangle> triangles_of(const MultiChartImage& image, const std::vector<uint32_t>& point) {
    const auto squared_distance = [&](uint32_t a, uint32_t b) {
        return (image.positions[point[a]] - image.positions[point[b]]).squaredNorm();
    };
    const uint32_t width = image.width();
    const std::vector<CellKind> kinds = classify_cells(image.mask, point);
    std::vector<CellTriangle> triangles;
    for (uint32_t cell = 0; cell < kinds.size(); ++cell) {
        const uint32_t first = cell / (width - 1) * width + cell % (width - 1);
        const bool main = kinds[cell] == CellKind::kShorter &&
                          squared_distance(first, first + width + 1) <= squared_distance(first + 1, first + width);
        const CellTriangles halves = triangles_of_cell(kinds[cell], first, width, main);
        for (uint32_t k = 0; k < halves.count; ++k) triangles.push_back({halves.triangles[k], cell});
    }
    return triangles;
}

Result<Reconstruction> reconstruct(const MultiChartImage& image) {
    const SampleMask& mask = image.mask;
    GIM_TRY(point, glue_samples(mask, image.seams));
    Reconstruction result;
    std::vector<uint32_t> vertex(mask.defined.size(), kNone);
    const auto vertex_of = [&](uint32_t sample) {
        uint32_t& v = vertex[point[sample]];
        if (v == kNone) {
            v = static_cast<uint32_t>(result.sample.size());
            result.sample.push_back(point[sample]);
            result.mesh.positions.push_back(image.positions[point[sample]]);
        }
        return v;
    };
    for (const CellTriangle& triangle : triangles_of(image, point)) {
        const auto [a, b, c] = triangle.corners;
        if (point[a] == point[b] || point[b] == point[c] || point[c] == point[a]) continue;
        result.mesh.triangles.push_back({vertex_of(a), vertex_of(b), vertex_of(c)});
    }
    return result;
}

}  // namespace gim
