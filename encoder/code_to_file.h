// The end of every encoding: codes images to bytes that meet the rate target, and completes the report.
#pragma once

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/code/contest.h"
#include "encoder/layout/layout_images.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Codes images to the target of the options. Compares the decoded surface with `reference`. `input`: the mesh as read,
// which has the colours. contest: the other sides of the square, if any. Returns the file with the completed report.
Result<Encoded> code_to_file(LayoutImages& images, Mesh reference, const TriangleMesh& input,
                             const EncodeOptions& options, const Contest& contest, StageClock& clock,
                             EncodeReport report);

}  // namespace gim
