#include "encoder/charts/multi_chart_image.h"

#include <algorithm>
#include <string>

#include "encoder/base/disjoint_sets.h"
#include "encoder/base/result.h"
#include "format/chart_split.h"

namespace gim {

namespace {

Error misfit(const std::string& what) { return {Stage::kSample, "the seam record does not fit the mask: " + what}; }

// Answers what chart_split asks of a mask.
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
        if (mate == kNoMate) continue;
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
                kind = kind_of(chart_split(grid, row, column));
            }
            kinds.push_back(kind);
        }
    }
    return kinds;
}

}  // namespace gim
