// The basis of tiles (encoder/fit/image_basis.h).
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/fit/image_basis.h"
#include "encoder/tiles/code_complex.h"
#include "format/container.h"
#include "format/detail_frame.h"

namespace gim {

// Where the samples of an image are: per tile of the code its grid of (side+1)^2 samples, row by row, as numbers of
// samples of the image. Several may be one number. Not copied, like the complex.
struct TilePlaces {
    const QuadComplex& complex;
    const std::vector<uint32_t>& samples;
    size_t count;  // samples of the image; those that no tile has are 0 and have no effect
};

class TileBasis final : public ImageBasis {
  public:
    // image: equal where tiles share samples. coding: in frames.
    TileBasis(const std::vector<float>& image, const TilePlaces& places, const TileShape& shape,
              const DetailCoding& coding);

    Coordinates analyse(const std::vector<float>& image) const override;
    std::vector<float> synthesize(const Coordinates& coordinates) const override;
    // Samples of the image that are one surface point may have different values.
    Coordinates transposed(std::vector<float> image) const override;

  private:
    std::vector<float> grids_of(const std::vector<float>& image) const;
    // Details on an edge belong to one of its tiles.
    void clear_copies(Coordinates& coordinates) const;

    TilePlaces places_;
    bool is_sharp_;
    uint32_t exponent_;
    std::vector<bool> is_first_;  // per place: no earlier place is the same sample of the image
};

}  // namespace gim
