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

// An image in the coordinates of its files.
struct CodedCoordinates {
    std::shared_ptr<const ImageBasis> basis;
    ImageBasis::Coordinates values;
};

class FitCodec {
  public:
    // Keeps a reference to gluing.
    explicit FitCodec(const GridGluing& gluing) : gluing_(gluing) {}
    virtual ~FitCodec() = default;

    // Returns coordinates of an image. Seams may be open in it: closed, it is the image.
    virtual CodedCoordinates coordinates(const std::vector<float>& image, const DetailCoding& coding) = 0;
    // Tells that the last coordinates were changed, so that what the image does not show of them follows.
    virtual void follow(const ImageBasis::Coordinates&) {}
    // Closes the seams of a synthesized image as decoders do, seen as a linear map, and its transpose. By default
    // samples at one surface point go to their mean.
    virtual void close(std::vector<float>& image) const { average_glued(image); }
    virtual void close_transposed(std::vector<float>& image) const { average_glued(image); }
    // The samples that a decoder has of a file of the image, in the frame of the fit. mends_folds: as files do.
    virtual std::vector<Vec3> decoded(const std::vector<float>& image, const Units& units, bool mends_folds) = 0;
    // Mends the folds that the quantizer leaves in the bands of a file, one pyramid for each part. Layouts whose files
    // have no such bands do nothing.
    virtual void repair(std::span<Pyramid<int32_t>>, const Units&) {}

  protected:
    const GridGluing& gluing() const { return gluing_; }
    // Replaces the values of each class by their mean. image: interleaved triples.
    void average_glued(std::vector<float>& image) const;

  private:
    const GridGluing& gluing_;
};

}  // namespace gim
