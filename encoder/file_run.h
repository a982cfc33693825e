// The end of every encoding: codes images to bytes that meet the rate target, and completes the report.
#pragma once

#include <memory>
#include <optional>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/code/contest.h"
#include "encoder/code/rate_target.h"
#include "encoder/layout/layout_images.h"
#include "encoder/surface/compare_meshes.h"
#include "encoder/surface/local_frame.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// What the images show, in the frame of the images.
struct Original {
    const ReferenceSurface& surface;  // clean; the decoded surface is compared with it
    const TriangleMesh& input;        // as read: it has the colours
    const LocalFrame& frame;
};

class FileRun {
  public:
    // Keeps references to the original and the clock. report: that of the input and of the stages so far.
    FileRun(std::unique_ptr<LayoutImages> images, const Original& original, const EncodeOptions& options,
            StageClock& clock, EncodeReport report);
    ~FileRun();

    // RateSearch::estimate(). finish() goes on from there.
    Result<Estimate> estimate(std::optional<double> near);

    // Returns the file, in object space, with the report completed but for the times. contest: RateSearch::run(). Call it once.
    Result<Encoded> finish(const Contest& contest);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Puts the times of a whole encoding into its report: those of all runs, also of the ones that lost. Ends the clock.
Result<Encoded> timed(Result<Encoded> encoded, StageClock& clock);

}  // namespace gim
