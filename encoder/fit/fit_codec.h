// What the fit to the codec asks of a layout's codec.
#pragma once

#include <memory>
#include <vector>

#include "encoder/fit/fitter.h"
#include "encoder/fit/image_basis.h"
#include "encoder/surface/mesh.h"
#include "format/container.h"
#include "format/detail_frame.h"

namespace gim {

class FitCodec {
  public:
    virtual ~FitCodec() = default;

    // The coordinates in which the layout codes an image. image: interleaved triples, in units.
    virtual std::unique_ptr<ImageBasis> basis(const std::vector<float>& image, const DetailCoding& coding) const = 0;

    // Returns where a decoder would put the samples of an image, in the frame. repairs: mends folds, if the layout can.
    virtual std::vector<Vec3> decoded(std::vector<float> image, const Units& units, const FitFrame& frame,
                                      bool repairs) = 0;
};

}  // namespace gim
