// The codec of tiles, as the fit sees it: images are atlases (sample_tiles.h).
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/fit/fit_codec.h"
#include "encoder/fit/fitter.h"
#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/tile_image.h"
#include "format/container.h"

namespace gim {

class TileCodec final : public FitCodec {
  public:
    // frame: of the fit. An Error names what is wrong with the complex.
    static Result<TileCodec> make(const TileImage& tiles, const FitFrame& frame);

    std::unique_ptr<ImageBasis> basis(const std::vector<float>& image, const DetailCoding& coding) const override;
    std::vector<Vec3> decoded(const std::vector<float>& image, const Units& units, bool mends_folds) override;

  private:
    TileCodec(CodedComplex coded, std::vector<uint32_t> texels, const TileShape& shape, size_t texel_count,
              const FitFrame& frame);

    CodedComplex coded_;
    std::vector<uint32_t> texels_;  // per place of the code: tile by tile, row by row, each in the tile's own slot
    TileShape shape_;
    size_t texel_count_;
    FitFrame frame_;
};

}  // namespace gim
