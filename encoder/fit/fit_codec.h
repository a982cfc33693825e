// What the fit to the codec knows of a codec: the basis in which files hold details, and the samples that a decoder has.
// Each layout has one.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "encoder/surface/mesh.h"
#include "format/container.h"
#include "format/detail_frame.h"

namespace gim {

// An image in the coordinates of lossy files: the base, and the wavelet details, each along the axes of its frame
// (format/detail_frame.h). Coordinates are triples: the base (x, y, z), then the details (normal, two tangents).
//
// Frames are made once, from the image that the basis is made for. Then the coordinates are a linear function of the
// samples. Analysis, synthesis and the transpose of synthesis are consistent linear maps. Images are interleaved triples
// of all samples of the grid, in units.
class FitBasis {
  public:
    using Coordinates = std::vector<float>;

    virtual ~FitBasis() = default;
    virtual size_t size() const = 0;
    virtual size_t base_size() const = 0;  // the first coordinates are those of the base
    // Per coordinate: quantizer step, and the L2 norm of its synthesis function.
    virtual float step(size_t i) const = 0;
    virtual float norm(size_t i) const = 0;
    // Area of a full-resolution cell near the detail, divided by the cell area of the coding.
    virtual float relative_area(size_t i) const = 0;
    // Whether another detail is used instead. The coordinate is then 0 and has no effect.
    virtual bool is_copy(size_t i) const = 0;
    bool is_tangential(size_t i) const { return i >= base_size() && i % 3 != 0; }

    virtual Coordinates analyse(const std::vector<float>& image) const = 0;
    virtual std::vector<float> synthesize(const Coordinates& coordinates) const = 0;
    // The transpose of synthesize.
    virtual Coordinates transposed(std::vector<float> image) const = 0;
};

class FitCodec {
  public:
    virtual ~FitCodec() = default;
    virtual std::unique_ptr<FitBasis> basis(const std::vector<float>& image, const DetailCoding& coding) const = 0;
    // The samples that a decoder has of a file of the image, in the frame of the fit. mends_folds: as files do.
    virtual std::vector<Vec3> decoded(const std::vector<float>& image, const Units& units, bool mends_folds) = 0;
    // Mends the folds that the quantizer leaves in the bands of a file. Layouts without such a repair do nothing.
    virtual void repair(Pyramid<int32_t>&, const Units&) {}
};

}  // namespace gim
