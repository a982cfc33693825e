// The basis of squares (fit_codec.h): the base, then band after band, coarsest level first.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "encoder/fit/fit_codec.h"
#include "format/detail_frame.h"
#include "format/rim.h"

namespace gim {

class DetailBasis final : public FitBasis {
  public:
    // image: side * side interleaved triples, in units. coding: in frames.
    // seams: of an image whose mates share their details; not copied.
    DetailBasis(const std::vector<float>& image, uint32_t side, const DetailCoding& coding,
                const SeamTable* seams = nullptr);

    size_t size() const override { return 3 * frames_.size(); }
    static constexpr size_t kBase = 4 * 3;
    size_t base_size() const override { return kBase; }
    float step(size_t i) const override { return is_tangential(i) ? tangential_steps_[i / 3] : steps_[i / 3]; }
    float norm(size_t i) const override { return norms_[i / 3]; }
    float relative_area(size_t i) const override { return areas_[i / 3]; }
    bool is_copy(size_t i) const override { return is_copy_[i / 3]; }

    Coordinates analyse(const std::vector<float>& image) const override;
    std::vector<float> synthesize(const Coordinates& coordinates) const override;
    Coordinates transposed(std::vector<float> image) const override;

  private:
    enum class Way { kIntoFrames, kOutOfFrames };
    void turn(Coordinates& coordinates, Way way) const;
    // Sets source = weight * (source + copy), copy = 0. The coordinates must be out of frames.
    void gather_copies(Coordinates& coordinates, float weight) const;

    uint32_t side_;
    const SeamTable* seams_;
    std::vector<std::pair<uint32_t, uint32_t>> copies_;  // triples: copy and source
    std::vector<bool> is_copy_;
    std::vector<DetailFrame> frames_;  // per triple
    std::vector<float> steps_, tangential_steps_, norms_, areas_;
};

}  // namespace gim
