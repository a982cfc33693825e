// The interface between drivers and layouts: finished images that drivers describe, fit and code. Each layout
// implements it in its own folder. No other code tells layouts apart once images are made.
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
    // Sets the images' figures in the report: layout, sizes, numbers of samples, cut-paths and charts.
    virtual void describe(EncodeReport& report) const = 0;

    // Returns whether fit() may be called: true for lossy images that are fitted to their quantizer.
    virtual bool is_fitted_to_quantizer() const { return false; }
    // Moves the samples to where they take few bytes at the quantizer of the parameters. Continues the last fit. Later
    // writers code the result.
    virtual void fit(const CodingParameters&, CodedFit::Effort, StageClock&) {}
    // Makes the next fit start from the first samples.
    virtual void restart_fit() {}
    // The same, and makes it the first fit again.
    virtual void forget_fits() {}

    // Returns a writer that codes seams and levels of the images as they are now.
    virtual Result<FileWriter> writer(const CodingParameters& parameters) const = 0;
};

}  // namespace gim
