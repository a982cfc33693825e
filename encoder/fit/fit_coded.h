// Fits the samples of a square image to its surface and to the codec at once: among the images that are equally near to
// the surface it looks for the one with the shortest file. Samples slide along the surface until the coarser image
// predicts them, details that are worth less than their bits vanish, and what the coarse quantization of the tangential
// details does to the surface is made good along the normal.
//
// After: Guskov, Vidimce, Sweldens, Schroeder. Normal Meshes. 2000 (samples where the coarser surface predicts them), as a
// least-squares fit instead of ray casting; the price of a coefficient is that of Candes, Wakin, Boyd. Enhancing Sparsity
// by Reweighted l1 Minimization. 2008, whose logarithm stands for bits.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "encoder/fit/fit.h"
#include "encoder/image/geometry_image.h"
#include "encoder/surface/mesh.h"
#include "format/container.h"
#include "format/seam.h"

namespace gim {

class CodedFit {
  public:
    // Keeps its own copies. start: of width and height 2^j + 1. seams: of the file; mates share their details. `seed`
    // decides where distances are sampled.
    CodedFit(const GeometryImage& start, const SeamTable& seams, const Mesh& reference, uint64_t seed);
    ~CodedFit();
    CodedFit(CodedFit&&) noexcept;
    CodedFit& operator=(CodedFit&&) noexcept;

    enum class Effort {
        kSearch,  // finds out about what a quantizer brings
        kFinal,   // and what its file will hold
        kAdjust,  // the last rounds of the final fit before again, with a quantizer nearby
    };
    // Goes on from where the last call ended (the start, at first). units: of the file to be. Returns the samples, equal where glued; steps fold nothing over, the quantizer may.
    // The same for any number of threads. Cost: of 257 x 257 samples about 0.3 s a round on two cores, 5, 24 or 9 rounds.
    std::vector<Vec3> run(const Units& units, Effort effort, const Progress& progress = {});
    // The next call goes on from the start again: samples that a coarse quantizer has heaped up do not come apart.
    void restart();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gim
