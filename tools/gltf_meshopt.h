// Buffer views compressed by EXT_meshopt_compression or KHR_meshopt_compression.
#pragma once

#include <span>

#include "tools/gltf_file.h"

namespace gim::gltf {

// `packed` is the extension of the view, `source` the bytes that it names. Takes the result from `memory`. Safe on
// untrusted bytes. Fails, by name, at what meshoptimizer 0.18 cannot decode: version 1 of the vertex codec, later index
// codecs, other modes and filters.
Bytes decode_meshopt(const Json& packed, std::span<const uint8_t> source, MemoryBudget& memory);

}  // namespace gim::gltf
