// What the fit to the codec knows of a codec: the basis in which files hold details, and the samples that a decoder has.
// Each layout has one.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "encoder/fit/fitter.h"
#include "encoder/fit/image_basis.h"
#include "encoder/image/gluing.h"
#include "encoder/surface/mesh.h"
#include "format/container.h"
#include "format/detail_frame.h"

namespace gim {

// What a codec may know of a fit. The fit owns what is named.
struct FitSetting {
    const GridGluing& gluing;
    const FitReference& reference;
    const FitFrame& frame;
    double front;  // the sign that makes the image face outwards
};

class FitCodec {
  public:
    virtual ~FitCodec() = default;
    virtual std::shared_ptr<const ImageBasis> basis(const std::vector<float>& image, const DetailCoding& coding) = 0;
    // Tells that the coordinates of the last basis were changed, so that samples which the image does not have follow.
    virtual void follow(const ImageBasis::Coordinates&) {}
    // The samples that a decoder has of a file of the image, in the frame of the fit. mends_folds: as files do.
    virtual std::vector<Vec3> decoded(const std::vector<float>& image, const Units& units, bool mends_folds) = 0;
    // Mends the folds that the quantizer leaves in the bands of a file, one pyramid for each part. Layouts whose files
    // have no such bands do nothing.
    virtual void repair(std::span<Pyramid<int32_t>>, const Units&) {}
};

}  // namespace gim
