// The end of every encoding: images to bytes that meet the rate target, and the figures of the run.
#pragma once

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/layout/layout_images.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Codes to the target of the options, judging the decoded surface against `reference`, and completes the report.
// `input`: the mesh as read, for its colours.
Result<Encoded> code_to_file(LayoutImages& images, Mesh reference, const TriangleMesh& input,
                             const EncodeOptions& options, StageClock& clock, EncodeReport report);

}  // namespace gim
