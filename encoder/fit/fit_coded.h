// Fits the samples of an image to its surface and to the codec at once. Among images that are equally near to the
// surface, looks for the one with the shortest file. Samples slide along the surface until the coarser image predicts
// them. Details that are worth less than their bits vanish. Moves along the normal make up for the coarse quantization
// of tangential details.
//
// After: Guskov, Vidimce, Sweldens, Schroeder. Normal Meshes. 2000 (samples lie where the coarser surface predicts
// them); we fit by least squares instead of casting rays. The price of a coefficient is that of Candes, Wakin, Boyd.
// Enhancing Sparsity by Reweighted l1 Minimization. 2008; its logarithm stands for bits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "encoder/fit/fit.h"
#include "encoder/fit/fit_codec.h"
#include "encoder/fit/fit_rounds.h"
#include "encoder/fit/fitter.h"
#include "encoder/image/geometry_image.h"
#include "encoder/image/rails.h"
#include "encoder/surface/mesh.h"
#include "format/container.h"

namespace gim {

// Makes the codec of a fit, whose samples are in the setting's frame.
using MakeFitCodec = std::function<std::unique_ptr<FitCodec>(const FitSetting& setting)>;

// A surface to fit to, in a frame of its own. Several fits may share it.
struct FitSurface {
    FitFrame frame;
    FitReference reference;

    explicit FitSurface(const Mesh& mesh);
};

class CodedFit {
  public:
    // Copies its arguments. `seed` decides where distances are sampled. Samples stay on their rails.
    CodedFit(const GeometryImage& start, const MakeFitCodec& make_codec, const Mesh& reference, uint64_t seed,
             const Rails& rails = {}, const FitRounds& rounds = {});
    CodedFit(const GeometryImage& start, const MakeFitCodec& make_codec, std::shared_ptr<const FitSurface> surface,
             uint64_t seed, const Rails& rails = {}, const FitRounds& rounds = {});
    ~CodedFit();
    CodedFit(CodedFit&&) noexcept;
    CodedFit& operator=(CodedFit&&) noexcept;

    enum class Effort {
        kSearch,  // quick: shows roughly what a quantizer gives
        kFinal,   // full: gives the samples of a file
        kCoarse,  // of a coarser image: all rounds of kFinal but the last ones
        kRefine,  // the last rounds of kFinal, from samples that a kCoarse fit of a coarser image has led to
        kAdjust,  // repeats the last rounds of the last kFinal or kRefine, at a quantizer nearby
    };
    // Continues from the end of the last call; the first call begins at the start. units: of the file to come. Returns
    // the samples, equal where glued. Steps fold nothing over, but the quantizer may. The result does not depend on the
    // number of threads. Cost, with the usual FitRounds: 5 rounds (kSearch), 29 (kFinal), 20 (kCoarse) or 9, each about
    // 0.3 s for 257 x 257 samples on two cores.
    std::vector<Vec3> run(const Units& units, Effort effort, const Progress& progress = {});
    // Repairs folds that the quantizer leaves in the bands of such samples (fold_repair.h).
    void repair(std::span<Pyramid<int32_t>> bands, const Units& units);
    // Makes the next call begin at the start again. Otherwise samples that a coarse quantizer heaped up stay together.
    void restart();
    // The same, as if there had been no call.
    void forget();

    std::vector<Vec3> positions() const;
    // Makes the next call begin at these samples. Glued ones go to their mean.
    void place(const std::vector<Vec3>& positions);
    // Returns the number of faces that look away from the surface.
    uint64_t folds() const;
    // Returns the larger of the RMS distances from the samples' faces to the surface and back, in the unit of the mesh.
    double distance() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gim
