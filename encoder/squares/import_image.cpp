#include "encoder/squares/import_image.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "format/ring.h"
#include "format/seam.h"
#include "format/sideband_code.h"

namespace gim {
namespace {

// Most pairs of matching edges per ring edge. With more, the ring is mostly one point.
constexpr size_t kMostPairsPerEdge = 64;

Error error(std::string message) { return {Stage::kInput, std::move(message)}; }

std::vector<Vec3> ring_positions(const SquareGrid& image) {
    std::vector<Vec3> ring;
    for (uint32_t k = 0; k < ring_length(image.side); ++k) {
        const GridPoint p = ring_point(image.side, k);
        ring.push_back(image.at(p.row, p.column));
    }
    return ring;
}

SquareGrid resampled(const SquareGrid& image, uint32_t side) {
    SquareGrid out;
    out.side = side;
    const double scale = double(image.side - 1) / double(side - 1);
    const auto place = [&](uint32_t i) {
        const auto first = std::min(static_cast<uint32_t>(i * scale), image.side - 2);
        return std::pair(first, i * scale - first);
    };
    for (uint32_t r = 0; r < side; ++r) {
        const auto [row, v] = place(r);
        for (uint32_t c = 0; c < side; ++c) {
            const auto [column, u] = place(c);
            const Vec3 top = (1 - u) * image.at(row, column) + u * image.at(row, column + 1);
            const Vec3 bottom = (1 - u) * image.at(row + 1, column) + u * image.at(row + 1, column + 1);
            out.positions.push_back((1 - v) * top + v * bottom);
        }
    }
    return out;
}

// An ordered pair of ring edges; edge k runs from ring sample k to k+1.
using EdgePair = std::pair<uint32_t, uint32_t>;

// Returns all pairs (e, f), e != f, with e's start at f's end and e's end at f's start, sorted.
std::vector<EdgePair> matching_edges(const std::vector<Vec3>& ring, double tolerance) {
    const auto count = static_cast<uint32_t>(ring.size());
    const auto next = [count](uint32_t k) { return k + 1 == count ? 0 : k + 1; };
    const auto near = [&](uint32_t a, uint32_t b) { return (ring[a] - ring[b]).norm() <= tolerance; };
    const auto middle_x = [&](uint32_t e) { return 0.5 * (ring[e].x() + ring[next(e)].x()); };
    std::vector<uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return middle_x(a) < middle_x(b); });

    std::vector<EdgePair> pairs;
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t j = i + 1; j < count && middle_x(order[j]) - middle_x(order[i]) <= tolerance; ++j) {
            const uint32_t e = order[i], f = order[j];
            if (!near(e, next(f)) || !near(next(e), f)) continue;
            pairs.emplace_back(e, f);
            pairs.emplace_back(f, e);
            if (pairs.size() > kMostPairsPerEdge * count) return {};
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

// Returns for each ring edge its mate, or kNoMate. Glues runs (e, f), (e+1, f-1), ... of matching pairs, longest first. A
// run ends where nothing matches, and at leaves, where it would come back.
std::vector<uint32_t> pair_edges(const std::vector<EdgePair>& pairs, uint32_t count) {
    struct Run {
        EdgePair first;
        uint32_t length;
    };
    const auto is_pair = [&](EdgePair p) { return std::binary_search(pairs.begin(), pairs.end(), p); };
    const auto forward = [count](EdgePair p) {
        return EdgePair(p.first + 1 == count ? 0 : p.first + 1, p.second == 0 ? count - 1 : p.second - 1);
    };
    const auto backward = [count](EdgePair p) {
        return EdgePair(p.first == 0 ? count - 1 : p.first - 1, p.second + 1 == count ? 0 : p.second + 1);
    };
    std::vector<Run> runs;
    const auto leaves_leaf = [count](EdgePair p) { return p.first == (p.second + 1) % count; };
    for (const EdgePair& p : pairs) {
        if (is_pair(backward(p)) && !leaves_leaf(p)) continue;
        Run run = {p, 1};
        for (EdgePair q = forward(p); is_pair(q) && !leaves_leaf(q); q = forward(q)) ++run.length;
        runs.push_back(run);
    }
    std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.length > b.length; });

    std::vector<uint32_t> mate(count, kNoMate);
    for (const Run& run : runs) {
        EdgePair p = run.first;
        for (uint32_t i = 0; i < run.length; ++i, p = forward(p)) {
            if (mate[p.first] != kNoMate || mate[p.second] != kNoMate) continue;
            mate[p.first] = p.second;
            mate[p.second] = p.first;
        }
    }
    return mate;
}

// Cuts the ring into paths where the run of mates breaks off. A leaf, where an edge is glued to the next, also ends
// one.
Sideband to_sideband(const std::vector<uint32_t>& mate, uint32_t side) {
    const auto count = static_cast<uint32_t>(mate.size());
    const auto begins_path = [&](uint32_t e) {
        const uint32_t before = mate[e == 0 ? count - 1 : e - 1];
        if (mate[e] == kNoMate || before == kNoMate) return mate[e] != before;
        return before == e || before != (mate[e] + 1) % count;
    };
    std::vector<uint32_t> starts;
    for (uint32_t e = 0; e < count; ++e) {
        if (begins_path(e)) starts.push_back(e);
    }
    if (starts.empty()) return {};  // the whole ring is open

    Sideband s;
    s.node_side = side;
    s.start = starts.front();
    for (size_t i = 0; i < starts.size(); ++i) {
        const uint32_t end = i + 1 < starts.size() ? starts[i + 1] : starts.front() + count;
        CutPath path;
        path.length = end - starts[i];
        if (mate[starts[i]] != kNoMate) {
            // The mate begins with the edge that this path's last edge is glued to.
            const uint32_t first = mate[end > count ? end - 1 - count : end - 1];
            path.mate = static_cast<uint32_t>(std::lower_bound(starts.begin(), starts.end(), first) - starts.begin());
        }
        s.paths.push_back(path);
    }
    return with_coarsest_node_grid(s);
}

// Returns the signed volume between the surface and the middle of its samples. It is exact for a closed surface; for an
// open one its sign is a fair guess.
double signed_volume(const SquareGrid& image) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : image.positions) middle += p / static_cast<double>(image.positions.size());
    double six_volumes = 0;
    for (uint32_t r = 0; r + 1 < image.side; ++r) {
        for (uint32_t c = 0; c + 1 < image.side; ++c) {
            const Vec3 a = image.at(r, c) - middle, b = image.at(r, c + 1) - middle;
            const Vec3 d = image.at(r + 1, c + 1) - middle, e = image.at(r + 1, c) - middle;
            six_volumes += a.dot(b.cross(d)) + a.dot(d.cross(e));
        }
    }
    return six_volumes / 6;
}

SquareGrid transposed(const SquareGrid& image) {
    SquareGrid out = image;
    for (uint32_t r = 0; r < image.side; ++r)
        for (uint32_t c = 0; c < image.side; ++c) out.at(c, r) = image.at(r, c);
    return out;
}

void weld(const SeamTable& seams, SquareGrid* image) {
    std::vector<uint32_t> class_of(ring_length(image->side));
    ring_classes(seams, image->side, class_of);
    const uint32_t count = *std::max_element(class_of.begin(), class_of.end()) + 1;
    std::vector<Vec3> sum(count, Vec3::Zero());
    std::vector<double> members(count, 0.0);
    for (uint32_t k = 0; k < class_of.size(); ++k) {
        const GridPoint p = ring_point(image->side, k);
        sum[class_of[k]] += image->at(p.row, p.column);
        ++members[class_of[k]];
    }
    for (uint32_t k = 0; k < class_of.size(); ++k) {
        const GridPoint p = ring_point(image->side, k);
        if (members[class_of[k]] > 1) image->at(p.row, p.column) = sum[class_of[k]] / members[class_of[k]];
    }
}

}  // namespace

Sideband find_gluing(const SquareGrid& image, double weld_tolerance) {
    const std::vector<EdgePair> pairs = matching_edges(ring_positions(image), weld_tolerance);
    return to_sideband(pair_edges(pairs, ring_length(image.side)), image.side);
}

Result<SquareImage> import_image(const std::vector<float>& channels, uint32_t side, double weld_tolerance) {
    const size_t samples = size_t{side} * side;
    if (side < 3 || side > (1u << kMaxSideExponent) + 1)
        return error("a geometry image of side " + std::to_string(side) + " cannot be coded: 3 to 16385 are possible");
    if (channels.size() != samples * 3)
        return error("a geometry image of side " + std::to_string(side) + " has " + std::to_string(samples * 3) +
                     " values, not " + std::to_string(channels.size()));
    if (!(weld_tolerance >= 0)) return error("the weld tolerance must not be negative");

    SquareGrid image;
    image.side = side;
    for (size_t i = 0; i < samples; ++i) {
        image.positions.emplace_back(channels[i], channels[samples + i], channels[2 * samples + i]);
        if (!image.positions.back().allFinite())
            return error("sample at row " + std::to_string(i / side) + ", column " + std::to_string(i % side) +
                         " is not finite; repair the image first");
    }
    if (!is_grid_side(side)) {
        uint32_t grid_side = 3;
        while (grid_side < side) grid_side = 2 * grid_side - 1;
        image = resampled(image, grid_side);
    }
    if (signed_volume(image) < 0) image = transposed(image);

    Sideband sideband = find_gluing(image, weld_tolerance);
    SeamTable seams;
    if (build_seam_table(sideband, &seams) != Status::kOk)
        return error("the ring matches itself in " + std::to_string(sideband.paths.size()) +
                     " pieces, more than a file can tell; try another weld tolerance");
    if (!level_is_closed(seams, image.side))
        return error(
            "glued where its boundary samples match, the image is not a manifold mesh (a cut that ends in a corner of "
            "the square, or repeated samples); try a smaller weld tolerance");
    weld(seams, &image);
    return glue_square(std::move(image), std::move(sideband));
}

}  // namespace gim
