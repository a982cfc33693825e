// The end of every encoding: codes images to bytes that meet the rate target, and completes the report.
#pragma once

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/code/contest.h"
#include "encoder/layout/layout_images.h"
#include "encoder/surface/local_frame.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// What the images show, in the frame of the images.
struct Original {
    Mesh surface;               // clean; the decoded surface is compared with it
    const TriangleMesh& input;  // as read: it has the colours
    const LocalFrame& frame;
};

// Codes images to the target of the options. contest: the other sides of the square, if any. Returns the file, in
// object space, with the completed report.
Result<Encoded> code_to_file(LayoutImages& images, Original original, const EncodeOptions& options,
                             const Contest& contest, StageClock& clock, EncodeReport report);

}  // namespace gim
