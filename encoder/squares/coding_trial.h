// Measures how many bytes images of one surface cost, by coding them.
#pragma once

#include <memory>

#include "encoder/base/result.h"
#include "encoder/fit/fit_coded.h"
#include "encoder/squares/square_image.h"
#include "encoder/surface/compare_meshes.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

class CodingTrial {
  public:
    // Keeps the surface. `options` must have a target that is searched for. Codes `example` to find out roughly which
    // quantizer the target asks for. Cost: 5 to 15 rounds of CodedFit.
    CodingTrial(const Mesh& surface, const EncodeOptions& options, const SquareImage& example);

    // Fits the image briefly to that quantizer and codes it. Returns the natural logarithm of its bytes, converted to
    // the same PSNR for all images, up to a constant of the trial. Cost: 5 rounds. Several threads may call it at once.
    Result<double> log_bytes(const SquareImage& image) const;

  private:
    struct Coded {
        double bytes, psnr;
    };
    Result<Coded> coded(const SquareImage& image, double quantizer) const;
    double quantizer_for(const SquareImage& image) const;

    ReferenceSurface surface_;
    std::shared_ptr<const FitSurface> fit_surface_;
    EncodeOptions options_;
    double quantizer_;
};

}  // namespace gim
