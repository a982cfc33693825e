// What images of one surface cost when they are coded, found out by coding them.
#pragma once

#include <optional>

#include "encoder/compare_meshes.h"
#include "encoder/geometry_image.h"
#include "encoder/mesh.h"
#include "encoder/result.h"
#include "gim/encoder.h"

namespace gim {

// Keeps the surface. options: with a rate target that a lossy file can meet.
class CodingTrial {
  public:
    CodingTrial(const Mesh& surface, const EncodeOptions& options) : surface_(surface, options.threads), options_(options) {}

    // Natural logarithm of the bytes that the image takes at one and the same PSNR, up to a constant of the trial, after a short
    // fit to about the quantizer that the first image of the trial asks for. Cost: 5 to 15 rounds of CodedFit for the first image, 5 for
    // others.
    Result<double> log_bytes(const GeometryImage& image);

  private:
    struct Coded {
        double bytes, psnr;
    };
    Result<Coded> coded(const GeometryImage& image, double quantizer) const;
    Result<double> quantizer_for(const GeometryImage& image) const;

    ReferenceSurface surface_;
    EncodeOptions options_;
    std::optional<double> quantizer_;
};

}  // namespace gim
