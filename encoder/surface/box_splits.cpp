#include "encoder/surface/box_splits.h"

#include <tbb/parallel_invoke.h>

#include "encoder/base/parallel.h"

namespace gim {

namespace {

constexpr uint32_t kLeafItems = 2;
constexpr uint32_t kBins = 16;
constexpr float kInfinity = Box::kInfinity;

struct Bin {
    Box box;
    uint32_t count = 0;
};

// Chooses the split of least expected cost among kBins per axis. Returns the position of the first item right of it.
uint32_t partition(std::vector<BoxItem>& items, uint32_t begin, uint32_t end) {
    std::array<float, 3> low = {kInfinity, kInfinity, kInfinity}, high = {-kInfinity, -kInfinity, -kInfinity};
    for (uint32_t i = begin; i < end; ++i) {
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], items[i].centre[k]);
            high[k] = std::max(high[k], items[i].centre[k]);
        }
    }
    const auto bin_of = [&](const BoxItem& item, int axis) {
        const float where = (item.centre[axis] - low[axis]) / (high[axis] - low[axis]) * float(kBins);
        return std::min(static_cast<uint32_t>(where), kBins - 1);
    };
    std::array<std::array<Bin, kBins>, 3> bins{};
    for (int axis = 0; axis < 3; ++axis) {
        if (!(high[axis] > low[axis])) continue;
        for (uint32_t i = begin; i < end; ++i) {
            Bin& bin = bins[axis][bin_of(items[i], axis)];
            bin.box.add(items[i].box);
            ++bin.count;
        }
    }
    float best_cost = kInfinity;
    int best_axis = -1;
    uint32_t best_bin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(high[axis] > low[axis])) continue;
        std::array<float, kBins> right_cost{};
        Box right;
        uint32_t right_count = 0;
        for (uint32_t b = kBins - 1; b > 0; --b) {
            right.add(bins[axis][b].box);
            right_count += bins[axis][b].count;
            right_cost[b] = right.half_area() * float(right_count);
        }
        Box left;
        uint32_t left_count = 0;
        for (uint32_t b = 1; b < kBins; ++b) {
            left.add(bins[axis][b - 1].box);
            left_count += bins[axis][b - 1].count;
            const float cost = left.half_area() * float(left_count) + right_cost[b];
            if (left_count > 0 && left_count < end - begin && cost < best_cost) {
                best_cost = cost;
                best_axis = axis;
                best_bin = b;
            }
        }
    }
    // If all centres are in one place (or costs are not numbers), any halving will do.
    if (best_axis < 0) return begin + (end - begin) / 2;
    const auto middle = std::partition(items.begin() + begin, items.begin() + end,
                                       [&](const BoxItem& item) { return bin_of(item, best_axis) < best_bin; });
    return static_cast<uint32_t>(middle - items.begin());
}

// Splits a range down to leaves. Returns its top split, or kNone if it is a leaf. Ranges deep in the tree are halved
// instead, which bounds the depth when splits are lopsided.
uint32_t build_range(std::vector<BoxItem>& items, std::vector<BoxSplit>& splits, uint32_t begin, uint32_t end,
                     int depth) {
    if (end - begin <= kLeafItems) return kNone;
    const uint32_t middle = depth > 48 ? begin + (end - begin) / 2 : partition(items, begin, end);
    BoxSplit& split = splits[middle];
    split.left = bounds(items, begin, middle);
    split.right = bounds(items, middle, end);
    const auto left = [&] { split.left_split = build_range(items, splits, begin, middle, depth + 1); };
    const auto right = [&] { split.right_split = build_range(items, splits, middle, end, depth + 1); };
    if (end - begin > 8192) {
        tbb::parallel_invoke(left, right);
    } else {
        left();
        right();
    }
    return middle;
}

}  // namespace

uint32_t split_boxes(std::vector<BoxItem>& items, std::vector<BoxSplit>& splits, uint32_t threads) {
    const auto count = static_cast<uint32_t>(items.size());
    splits.resize(count);
    uint32_t top = kNone;
    with_threads(threads, [&] { top = build_range(items, splits, 0, count, 0); });
    return top;
}

Box bounds(const std::vector<BoxItem>& items, uint32_t begin, uint32_t end) {
    Box box;
    for (uint32_t i = begin; i < end; ++i) box.add(items[i].box);
    return box;
}

}  // namespace gim
