// What the drivers ask of a layout: images that are made and may be described, fitted and coded. Each layout implements this
// in its own folder; nothing else tells layouts apart once images are made.
#pragma once

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/code/file_writer.h"
#include "encoder/fit/fit_coded.h"
#include "encoder/planes/plane_images.h"
#include "gim/encoder.h"

namespace gim {

class LayoutImages : public PlaneImages {
  public:
    // Sets the figures of the images: layout, sizes, numbers of samples, cut-paths and charts.
    virtual void describe(EncodeReport& report) const = 0;

    // Whether fit() may be called: lossy images that are fitted to their quantizer.
    virtual bool is_fitted_to_quantizer() const { return false; }
    // Moves the samples to where they cost few bytes at the quantizer of the parameters. Goes on from the fit before; writers
    // made afterwards code the result.
    virtual void fit(const CodingParameters&, CodedFit::Effort, StageClock&) {}
    // The next fit starts from the first samples.
    virtual void restart_fit() {}

    // Codes seams and levels of the images as they are now.
    virtual Result<FileWriter> writer(const CodingParameters& parameters) const = 0;
};

}  // namespace gim
