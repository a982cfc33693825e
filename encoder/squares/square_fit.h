// Fits a square to its surface and to the codec (fit/fit_coded.h), from coarse to fine: most rounds of a full fit run on
// the image of half the side, at a quarter of their cost.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "encoder/fit/fit_coded.h"
#include "encoder/squares/square_image.h"
#include "encoder/surface/mesh.h"
#include "format/seam.h"
#include "gim/encoder.h"

namespace gim {

// The side of the smallest squares that are fitted from coarse to fine.
inline constexpr uint32_t kLeastSideFromCoarse = 257;

// Whether another fit (fit/fit.h) comes before the one to the codec. A single fit to the codec unfolds the samples itself, and
// needs no other where they are many. On small sides, and in a search, whose quick fits unfold little, files take up to 4 %
// more bytes without one.
bool needs_first_fit(const EncodeOptions& options, uint32_t side);

class SquareFit {
  public:
    // Copies its arguments. The image's sideband must be valid.
    SquareFit(const SquareImage& start, const Mesh& surface, uint64_t seed, const FitRounds& rounds = {});

    // As CodedFit. A full fit (kFinal) of a large square first fits its low band, as an image of half the side. The finest
    // details then begin at zero. Where every second sample shows too little of the surface, all rounds run at the full
    // side.
    std::vector<Vec3> run(const Units& units, CodedFit::Effort effort, const Progress& progress = {});
    void repair(std::span<Pyramid<int32_t>> bands, const Units& units) { fine_.repair(bands, units); }
    void restart() { fine_.restart(); }
    void forget() { fine_.forget(); }
    uint64_t folds() const { return fine_.folds(); }

  private:
    void begin_coarse();
    bool is_led_by_coarse(const Units& units);
    // Moves the samples of fine_ to where the coarse image leads them.
    void fit_coarsely(const Units& units, const Progress& progress);

    uint32_t side_;
    uint64_t seed_;
    FitRounds rounds_;
    SeamTable seams_;
    std::shared_ptr<const FitSurface> surface_;
    // Every second sample, until a full fit needs them. Nothing for small squares, and where the cut has no room on the
    // coarser grid.
    std::optional<SquareImage> half_;
    std::optional<CodedFit> coarse_;
    double coarse_distance_ = 0;  // of every second sample, as taken from the surface
    CodedFit fine_;
};

}  // namespace gim
