// The basis of squares (image_basis.h).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "encoder/fit/image_basis.h"
#include "format/detail_frame.h"
#include "format/rim.h"

namespace gim {

class DetailBasis final : public ImageBasis {
  public:
    // image: side * side interleaved triples, in units. coding: in frames.
    // seams: of an image whose mates share their details; not copied.
    DetailBasis(const std::vector<float>& image, uint32_t side, const DetailCoding& coding,
                const SeamTable* seams = nullptr);

    Coordinates analyse(const std::vector<float>& image) const override;
    std::vector<float> synthesize(const Coordinates& coordinates) const override;
    Coordinates transposed(std::vector<float> image) const override;

  private:
    // Sets source = weight * (source + copy), copy = 0. The coordinates must be out of frames.
    void gather_copies(Coordinates& coordinates, float weight) const;

    uint32_t side_;
    const SeamTable* seams_;
    std::vector<std::pair<uint32_t, uint32_t>> copies_;  // triples: copy and source
};

}  // namespace gim
