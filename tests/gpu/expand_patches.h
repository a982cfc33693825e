// Patches to triangles by the processor, and whether triangles leave gaps.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gim/refine.h"
#include "tests/gpu/software_frame.h"
#include "tools/gpu/surface_data.h"

namespace gim::test {

using Sample = std::array<uint32_t, 2>;        // column, row
using SampleTriangle = std::array<Sample, 3>;  // counter-clockwise seen from outside

// Draws patches as the shaders promise. extra: halvings of every cell.
std::vector<SampleTriangle> expand_patches(std::span<const gim_patch> patches, const SurfaceData& surface,
                                           uint32_t extra = 0);

// With positions, and the places in the normal map by ShaderDomain's rule.
std::vector<SoftTriangle> placed(std::span<const SampleTriangle> triangles, const SurfaceData& surface);

// Edges that no other triangle goes back along. Corners at one place are one vertex. A closed surface has none.
uint64_t count_open_edges(std::span<const SoftTriangle> triangles);

}  // namespace gim::test
