// Which glTF extensions change what gim reads.
#pragma once

#include "tools/gltf_json.h"

namespace gim::gltf {

// Fails, by name, if the file requires an extension that gim does not know and that may change its shape. Returns
// warnings for such extensions that are used but not required.
std::vector<std::string> check_extensions(const Json& root);

}  // namespace gim::gltf
