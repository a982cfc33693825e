#include "encoder/multi_chart_image.h"

#include <algorithm>
#include <string>

#include "encoder/disjoint_sets.h"
#include "encoder/result.h"

namespace gim {

namespace {

Error misfit(const std::string& what) { return {Stage::kSample, "the seam record does not fit the mask: " + what}; }

// Samples of every path from its begin to its end node, both included.
Result<std::vector<std::vector<uint32_t>>> path_samples(const SampleMask& mask, const SeamRecord& seams) {
    const std::vector<std::vector<uint32_t>> loops = trace_borders(mask);
    if (loops.size() != seams.loops.size()) return misfit("another number of charts");
    std::vector<std::vector<uint32_t>> samples;
    for (size_t l = 0; l < loops.size(); ++l) {
        size_t at = seams.loops[l].first;
        if (at >= loops[l].size() || seams.loops[l].path_count == 0) return misfit("a chart without a first path");
        size_t total = 0;
        for (uint32_t k = 0; k < seams.loops[l].path_count; ++k) {
            if (samples.size() == seams.paths.size()) return misfit("too few paths");
            const uint32_t length = seams.paths[samples.size()].length;
            total += length;
            if (length == 0 || total > loops[l].size()) return misfit("paths longer than their border");
            samples.emplace_back();
            for (uint32_t i = 0; i <= length; ++i) samples.back().push_back(loops[l][(at + i) % loops[l].size()]);
            at += length;
        }
        if (total != loops[l].size()) return misfit("paths shorter than their border");
    }
    if (samples.size() != seams.paths.size()) return misfit("too many paths");
    return samples;
}

}  // namespace

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

Result<Reconstruction> reconstruct(const MultiChartImage& image) {
    const SampleMask& mask = image.mask;
    GIM_TRY(point, glue_samples(mask, image.seams));
    std::vector<uint8_t> on_border(mask.defined.size(), 0);
    for (const auto& loop : trace_borders(mask)) {
        for (const uint32_t i : loop) on_border[i] = 1;
    }
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
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        if (point[a] == point[b] || point[b] == point[c] || point[c] == point[a]) return;
        result.mesh.triangles.push_back({vertex_of(a), vertex_of(b), vertex_of(c)});
    };
    for (uint32_t row = 0; row + 1 < mask.height; ++row) {
        for (uint32_t column = 0; column + 1 < mask.width; ++column) {
            const uint32_t first = row * mask.width + column;
            const std::array<uint32_t, 4> all{first, first + 1, first + mask.width + 1, first + mask.width};
            std::array<uint32_t, 4> corner{};
            uint32_t count = 0;
            for (const uint32_t i : all) {
                if (mask.defined[i]) corner[count++] = i;
            }
            if (count == 3) add(corner[0], corner[1], corner[2]);
            if (count != 4) continue;
            const bool main_on_border = on_border[all[0]] && on_border[all[2]];
            const bool anti_on_border = on_border[all[1]] && on_border[all[3]];
            bool main_diagonal = true;
            if (main_on_border != anti_on_border) {
                main_diagonal = anti_on_border;
            } else if (!main_on_border) {
                const auto length = [&](uint32_t a, uint32_t b) {
                    return (image.positions[point[a]] - image.positions[point[b]]).squaredNorm();
                };
                main_diagonal = length(all[0], all[2]) <= length(all[1], all[3]);
            }
            if (main_diagonal) {
                add(all[0], all[1], all[2]);
                add(all[0], all[2], all[3]);
            } else {
                add(all[0], all[1], all[3]);
                add(all[1], all[2], all[3]);
            }
        }
    }
    return result;
}

}  // namespace gim
