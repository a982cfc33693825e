// The header again, from the bytes: gim_info is the caller's to damage, and holds no pointers.
#pragma once

#include <cstddef>

#include "format/container.h"
#include "gim/decoder.h"

namespace gim {

ContainerLimits limits_of(const gim_limits* limits);

// kBadArgument where the bytes are not those that info was read from.
Status reopen(const gim_info* info, const void* bytes, size_t size, Header* header);

}  // namespace gim
