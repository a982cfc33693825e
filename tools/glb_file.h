// The container of binary glTF.
#pragma once

#include <string>
#include <vector>

#include "tools/file.h"

namespace gim {

// Returns a GLB of the JSON and the bytes of its first buffer. Fails above 4 GB.
Result<Bytes> glb_bytes(const std::string& json, Bytes binary);

// glTF asks for unit normals. Where the surface has none, any direction will do.
void replace_zero_normals(std::vector<float>& normals);

}  // namespace gim
