// The codec of tiles, as the fit sees it: images are atlases (sample_tiles.h).
#pragma once

#include <memory>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/fit/fit_codec.h"
#include "encoder/fit/fold_passes.h"
#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/tile_fold_image.h"
#include "encoder/tiles/tile_image.h"
#include "encoder/tiles/tile_pyramid.h"
#include "encoder/tiles/tile_responses.h"
#include "format/container.h"

namespace gim {

class TileCodec final : public FitCodec {
  public:
    // Keeps references to what the setting names. An Error names what is wrong with the complex.
    static Result<std::unique_ptr<TileCodec>> make(const TileImage& tiles, const FitSetting& setting);
    TileCodec(const TileCodec&) = delete;
    TileCodec& operator=(const TileCodec&) = delete;

    CodedCoordinates coordinates(const std::vector<float>& image, const DetailCoding& coding) override;
    std::vector<Vec3> decoded(const std::vector<float>& image, const Units& units, bool mends_folds) override;
    // Mends the folds that the quantizer leaves in the integers of a file of such an image (fold_passes.h).
    void repair(TilePyramid<int32_t>& pyramid, const Units& units, const RepairEffort& effort = kLastRepairOfTiles);

  private:
    TileCodec(CodedComplex coded, TileTexels texels, const TileShape& shape, const FitSetting& setting);

    TilePyramid<int32_t> quantized(const std::vector<float>& image, const Units& units) const;

    CodedComplex coded_;
    TileTexels texels_;
    TileShape shape_;
    FitFrame frame_;
    TileResponses responses_;
    FoldPasses passes_;
};

}  // namespace gim
