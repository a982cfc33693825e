// The coded image of tiles, as the repair of folds sees it (encoder/fit/coded_image.h). Its parts are the tiles of the
// code, so details of tiles beside a cell count as well.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/fit/coded_image.h"
#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/tile_pyramid.h"
#include "encoder/tiles/tile_responses.h"
#include "format/container.h"
#include "format/quad_complex.h"

namespace gim {

// Where the samples of tiles are in an atlas.
struct TileTexels {
    uint32_t width = 0;               // of the atlas
    std::vector<uint32_t> of_sample;  // per sample of the grids of the tiles of the code: its texel
    std::vector<uint32_t> sample_at;  // per texel: the sample of the grids, or kNone
};

// side: intervals along a side of a tile.
TileTexels texels_of(const CodedComplex& coded, uint32_t side);

class TileFoldImage final : public CodedImage {
  public:
    // Keeps references to all but shape and units.
    TileFoldImage(const QuadComplex& complex, const TileShape& shape, const TileTexels& texels,
                  TileResponses& responses, TilePyramid<int32_t>& pyramid, const Units& units)
        : complex_(complex),
          shape_(shape),
          texels_(texels),
          responses_(responses),
          pyramid_(pyramid),
          units_(units),
          coding_(detail_coding_of(units)) {}

    const Units& units() const override { return units_; }
    Levels decode() const override { return decode(pyramid_); }
    Levels decode_changed(const PlaceInPart& place, uint32_t component, int32_t by) const override;
    std::vector<float> samples(const Levels& levels) const override;
    DetailFrame frame(const Levels& levels, const PlaceInPart& place) const override;
    uint32_t depths(uint32_t) const override { return shape_.exponent; }
    DetailSteps steps_at(uint32_t depth) const override;
    Band band(const PlaceInPart& place) override;
    std::vector<Band> bands() override;
    std::vector<CellInPart> parts_at(uint32_t cell) const override;
    PlaceInPart source_of(const PlaceInPart& place) const override;
    WeightedSamples moved_by(const PlaceInPart& source) const override { return responses_.at(source); }

  private:
    Levels decode(const TilePyramid<int32_t>& pyramid) const;
    Band band_in(TilePyramid<int32_t>& pyramid, const PlaceInPart& place) const;

    const QuadComplex& complex_;
    TileShape shape_;
    const TileTexels& texels_;
    TileResponses& responses_;
    TilePyramid<int32_t>& pyramid_;
    Units units_;
    DetailCoding coding_;
};

}  // namespace gim
