// Patches that are not too large for one call of a tessellator, or for one workgroup.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gim/refine.h"

namespace gim {

struct InstancedPatches {
    std::vector<gim_patch> patches;
    std::vector<uint32_t> instances;  // of each patch
};

// Appends the patches to `list`, for an instance. A patch is quartered until its borders have at most 2^most_edges edges,
// when the instance halves its cells `extra` times. The vertices on the borders between patches stay the same.
void add_patches(std::span<const gim_patch> patches, uint32_t instance, uint32_t most_edges, uint32_t extra,
                 InstancedPatches* list);

}  // namespace gim
