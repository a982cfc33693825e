// An image in the coordinates of lossy files: the base, and the wavelet details of all bands, each along the axes of
// its frame (format/detail_frame.h). Each layout has its own wavelet.
//
// Frames are made once, from the image that the basis is made for. Then the coordinates are a linear function of the
// samples. Analysis, synthesis and the transpose of synthesis are consistent linear maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/detail_frame.h"

namespace gim {

class ImageBasis {
  public:
    // Triples, in units: the base (x, y, z), then band after band, coarsest level first (normal, two tangents).
    using Coordinates = std::vector<float>;

    virtual ~ImageBasis() = default;

    size_t size() const { return 3 * frames_.size(); }
    size_t base_size() const { return base_size_; }  // coordinates of the base
    // Per coordinate: quantizer step, and the L2 norm of its synthesis function.
    float step(size_t i) const { return is_tangential(i) ? tangential_steps_[i / 3] : steps_[i / 3]; }
    float norm(size_t i) const { return norms_[i / 3]; }
    // Area of a full-resolution cell near the detail, divided by the cell area of the coding.
    float relative_area(size_t i) const { return areas_[i / 3]; }
    // Returns true if another coordinate is used instead. The coordinate is then 0 and has no effect.
    bool is_copy(size_t i) const { return is_copy_[i / 3]; }
    bool is_tangential(size_t i) const { return i >= base_size_ && i % 3 != 0; }

    // Images are interleaved triples, in units.
    virtual Coordinates analyse(const std::vector<float>& image) const = 0;
    virtual std::vector<float> synthesize(const Coordinates& coordinates) const = 0;
    // The transpose of synthesize.
    virtual Coordinates transposed(std::vector<float> image) const = 0;

  protected:
    enum class Way { kIntoFrames, kOutOfFrames };
    void turn(Coordinates& coordinates, Way way) const;

    // Adds triples of the base, all of one step and norm. Call it before add_detail().
    void add_base(size_t triples, float step, float norm);
    void add_detail(const DetailFrame& frame, const DetailSteps& steps, Orientation orientation, float norm);

    size_t base_size_ = 0;
    std::vector<bool> is_copy_;  // per triple, like all below
    std::vector<DetailFrame> frames_;
    std::vector<float> steps_, tangential_steps_, norms_, areas_;
};

}  // namespace gim
