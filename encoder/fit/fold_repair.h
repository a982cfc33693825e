// Repairs the folds that the quantizer leaves in coded squares and charts (fold_passes.h).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "encoder/fit/fitter.h"
#include "encoder/fit/fold_passes.h"
#include "encoder/fit/parts_image.h"
#include "encoder/image/geometry_image.h"
#include "encoder/image/gluing.h"
#include "encoder/surface/mesh.h"
#include "format/container.h"

namespace gim {

class FoldRepair {
  public:
    // Keeps references to gluing and reference. front: the sign that makes the image face outwards.
    FoldRepair(const GridGluing& gluing, const FitReference& reference, const FitFrame& frame, double front,
               std::vector<CodedPart> parts, CloseSeams close);

    // The same for an image by itself. Keeps a reference to its gluing. mesh: its surface; copied.
    FoldRepair(const GeometryImage& image, const Mesh& mesh, std::vector<CodedPart> parts, CloseSeams close);

    // bands: of each part; lossy. As FoldPasses::repair().
    void repair(std::span<Pyramid<int32_t>> bands, const Units& units, const RepairEffort& effort);

    // Returns the images that a decoder has on its way, of each part, before it closes the seams.
    CodedImage::Levels levels(std::span<const Pyramid<int32_t>> bands, const Units& units) const {
        return parts_.decode(bands, units);
    }
    // Returns the samples that a decoder makes of them with closed seams, in the frame.
    std::vector<Vec3> samples(const CodedImage::Levels& levels, const Units& units) const;

  private:
    void make_responses();

    FitFrame frame_;
    std::unique_ptr<FitReference> own_reference_;  // or none
    ImageParts parts_;
    std::vector<DetailResponses> responses_;  // per part
    FoldPasses passes_;
};

}  // namespace gim
