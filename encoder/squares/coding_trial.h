// What images of one surface cost when they are coded, found out by coding them.
#pragma once

#include "encoder/base/result.h"
#include "encoder/squares/square_image.h"
#include "encoder/surface/compare_meshes.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

class CodingTrial {
  public:
    // Keeps the surface. options: with a PSNR or bytes to aim at; `example` tells about which quantizer that asks for. Cost: 5 to 15
    // rounds of CodedFit.
    CodingTrial(const Mesh& surface, const EncodeOptions& options, const SquareImage& example);

    // Natural logarithm of the bytes that the image takes at one and the same PSNR, up to a constant of the trial, after a short
    // fit to that quantizer. Cost: 5 rounds. May be called at once from several threads.
    Result<double> log_bytes(const SquareImage& image) const;

  private:
    struct Coded {
        double bytes, psnr;
    };
    Result<Coded> coded(const SquareImage& image, double quantizer) const;
    double quantizer_for(const SquareImage& image) const;

    ReferenceSurface surface_;
    EncodeOptions options_;
    double quantizer_;
};

}  // namespace gim
