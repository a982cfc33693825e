// The container of binary glTF.
#pragma once

#include <string>

#include "tools/file.h"

namespace gim {

// Returns a GLB of the JSON and the bytes of its first buffer. Fails above 4 GB.
Result<Bytes> glb_bytes(const std::string& json, Bytes binary);

}  // namespace gim
