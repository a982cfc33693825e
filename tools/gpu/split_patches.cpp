#include "tools/gpu/split_patches.h"

#include <algorithm>

namespace gim {
namespace {

void add(const gim_patch& patch, uint32_t instance, uint32_t most_edges, uint32_t extra, InstancedPatches* list) {
    const uint32_t finest = patch.inside + extra + (patch.finer != 0 ? 1 : 0);
    if (patch.inside == 0 || std::min<uint32_t>(patch.side, finest) <= most_edges) {
        list->patches.push_back(patch);
        list->instances.push_back(instance);
        return;
    }
    const uint32_t half = 1u << (patch.side - 1);
    // The borders of the whole that each quarter has, and where it lies.
    const struct {
        uint32_t right, down;
        uint8_t borders;
    } quarters[4] = {{0, 0, 1 | 8}, {1, 0, 1 | 2}, {1, 1, 2 | 4}, {0, 1, 4 | 8}};
    for (const auto& q : quarters) {
        gim_patch part = patch;
        part.column = static_cast<uint16_t>(patch.column + q.right * half);
        part.row = static_cast<uint16_t>(patch.row + q.down * half);
        --part.side;
        --part.inside;
        part.finer &= q.borders;
        add(part, instance, most_edges, extra, list);
    }
}

}  // namespace

void add_patches(std::span<const gim_patch> patches, uint32_t instance, uint32_t most_edges, uint32_t extra,
                 InstancedPatches* list) {
    for (const gim_patch& patch : patches) add(patch, instance, most_edges, extra, list);
}

}  // namespace gim
