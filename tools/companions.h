// The files that belong to a mesh file: materials, textures, buffers.
#pragma once

#include <string>

namespace gim {

// True if the mesh file, or a material file that it names, names `other`, and that exists. Compares the last part of
// the name only, so it may take a stranger's file for a companion. A .gim file is nobody's companion. Streams have none.
bool is_companion(const std::string& mesh, const std::string& other);

}  // namespace gim
