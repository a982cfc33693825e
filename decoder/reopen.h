// Reads the header again from the bytes: gim_info holds no pointers, and the caller may have damaged it.
#pragma once

#include <cstddef>

#include "format/container.h"
#include "gim/decoder.h"

namespace gim {

ContainerLimits limits_of(const gim_limits* limits);

// Returns kBadArgument if the bytes are not those that info was read from.
Status reopen(const gim_info* info, const void* bytes, size_t size, Header* header);

}  // namespace gim
