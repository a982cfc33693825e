// Repairs the folds that the quantizer leaves in a coded image. Finds faces of the decoded surface that look away from
// the reference. Changes single coefficients around them by one step, where that pays.
//
// A change pays if what it saves in folds is worth more than what it adds in bits and in distance. Rate-distortion
// optimised quantization does the same for distance alone: Ramchandran, Vetterli. Rate-Distortion Optimal Fast
// Thresholding with Complete JPEG/MPEG Decoder Compatibility. 1994.
//
// Each pass decodes the image, visits its folded cells in order, and applies the best change at each at once. It
// assumes that the frames of finer details stay. The next pass sees what the decoder really does. Where several
// neighbours are folded, one pass also tries coarser details. It decodes for each of these, since frames turn with them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "encoder/fit/detail_reach.h"
#include "encoder/fit/fitter.h"
#include "encoder/image/geometry_image.h"
#include "encoder/image/gluing.h"
#include "encoder/surface/mesh.h"
#include "format/container.h"
#include "format/seam.h"

namespace gim {

// Closes the seams of a whole image as the decoder does. image: interleaved triples, in units.
using CloseSeams = std::function<void(std::vector<float>& image)>;

// What folds are worth, and the most passes.
struct RepairEffort {
    int passes;
    double fold;  // bits that a folded face is worth at least
    double turn;  // bits for each unit of its cosine
};
// The last repair of a file, and those between the rounds of a fit. The latter must be cheap: what they spend on a fold,
// the next rounds undo. With the last ones' price, files take 3 to 5 % more bytes and have more folds.
inline constexpr RepairEffort kLastRepair = {8, 15, 10}, kRepairBetween = {1, 2, 5};

class FoldRepair {
  public:
    // Keeps references to gluing and reference. front: the sign that makes the image face outwards.
    FoldRepair(const GridGluing& gluing, const FitReference& reference, const FitFrame& frame, double front,
               std::vector<CodedPart> parts, CloseSeams close);

    // The same for an image by itself. Keeps a reference to its gluing. mesh: its surface; copied.
    FoldRepair(const GeometryImage& image, const Mesh& mesh, std::vector<CodedPart> parts, CloseSeams close);

    // bands: of each part; lossy. Makes at most effort.passes passes. Deterministic at any number of threads.
    // Leaves an image alone where three in a hundred cells seem folded: then sheets lie nearer to each other than the
    // samples to them, and repairs would only move samples away. Cost: a decoding for each pass and each coarse trial,
    // and about a millisecond for each folded cell.
    void repair(std::span<Pyramid<int32_t>> bands, const Units& units, const RepairEffort& effort);

    // Returns the decoded samples with closed seams, in the frame.
    std::vector<Vec3> decode(std::span<const Pyramid<int32_t>> bands, const Units& units) const;

  private:
    friend class FoldPass;

    // The images of a part at all levels, coarsest first, in units around the middle.
    using LevelImages = std::vector<std::vector<float>>;
    std::vector<LevelImages> images(std::span<const Pyramid<int32_t>> bands, const Units& units) const;
    std::vector<Vec3> samples(const std::vector<LevelImages>& images, const Units& units) const;

    const GridGluing& gluing_;
    FitFrame frame_;
    std::unique_ptr<FitReference> own_reference_;  // or none
    const FitReference& reference_;
    double front_;
    std::vector<CodedPart> parts_;
    CloseSeams close_;
    std::vector<DetailResponses> responses_;  // per part
    std::vector<uint32_t> nearest_;           // per slot: a face of the reference that was near
    std::vector<uint8_t> is_stuck_;           // per cell: no change pays, and nothing near it has changed since
};

}  // namespace gim
