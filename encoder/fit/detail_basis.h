// An image in the coordinates of lossy files: the base, and the wavelet details of all bands, each along the axes of
// its frame (format/detail_frame.h).
//
// Frames are made once, from the image that the basis is made for. Then the coordinates are a linear function of the
// samples. Analysis, synthesis and the transpose of synthesis are consistent linear maps.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "format/detail_frame.h"
#include "format/rim.h"

namespace gim {

class DetailBasis {
  public:
    // Triples, in units: the base (x, y, z), then band after band, coarsest level first (normal, two tangents).
    using Coordinates = std::vector<float>;

    // image: side * side interleaved triples, in units. coding: in frames.
    // seams: of an image whose mates share their details; not copied.
    DetailBasis(const std::vector<float>& image, uint32_t side, const DetailCoding& coding,
                const SeamTable* seams = nullptr);

    size_t size() const { return 3 * frames_.size(); }
    static constexpr size_t kBase = 4 * 3;  // coordinates of the base
    // Per coordinate: quantizer step, and the L2 norm of its synthesis function.
    float step(size_t i) const { return is_tangential(i) ? tangential_steps_[i / 3] : steps_[i / 3]; }
    float norm(size_t i) const { return norms_[i / 3]; }
    // Area of a full-resolution cell near the detail, divided by the cell area of the coding.
    float relative_area(size_t i) const { return areas_[i / 3]; }
    // Returns true if the detail's mate is used instead. The coordinate is then 0 and has no effect.
    bool is_copy(size_t i) const { return is_copy_[i / 3]; }
    static bool is_tangential(size_t i) { return i >= kBase && i % 3 != 0; }

    Coordinates analyse(const std::vector<float>& image) const;
    std::vector<float> synthesize(const Coordinates& coordinates) const;
    // The transpose of synthesize.
    Coordinates transposed(std::vector<float> image) const;

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
