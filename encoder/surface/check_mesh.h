// Checks the numbers of a mesh as read from a file.
#pragma once

#include "encoder/base/result.h"
#include "gim/encoder.h"

namespace gim {

// An Error unless there are triangles, positions are finite, triangles index them, and the normals fit them. O(V + F).
Result<void> check_numbers(const TriangleMesh& input);

}  // namespace gim
