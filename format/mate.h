// The path on the other side of a seam.
#pragma once

#include <cstdint>

namespace gim {

// In place of the number of a mate: the path is a boundary of the surface.
inline constexpr uint32_t kNoMate = UINT32_MAX;

}  // namespace gim
