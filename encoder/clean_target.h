// Prepares the mesh to which an imported image is fitted.
#pragma once

#include "encoder/base/result.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Cleans the mesh as encode() does, and adds to the report what encode() says of its input. An Error names the mesh.
Result<Mesh> clean_target(const TriangleMesh& mesh, const EncodeOptions& options, EncodeReport& report);

}  // namespace gim
