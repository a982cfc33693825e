#include "encoder/tiles/tile_fit_codec.h"

#include <utility>

#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/tile_basis.h"
#include "encoder/tiles/tile_pyramid.h"
#include "format/tile_atlas.h"
#include "format/tile_lifting.h"

namespace gim {
namespace {

class TileFitCodec final : public FitCodec {
  public:
    TileFitCodec(const TileImage& image, const QuadComplex& complex) : coded_(code_complex(image, complex)) {
        const QuadComplex& view = coded_.complex.view();
        shape_ = {view.tiles,     view.vertices,  view.edges - 2 * view.tiles,
                  image.exponent, image.is_sharp, !image.sharp.empty()};
        const uint32_t side = shape_.intervals(0);
        const TileAtlas atlas(view.tiles, side);
        for_each_coded_sample(coded_, side, [&](uint32_t tile, uint32_t row, uint32_t column) {
            texels_.push_back((atlas.row(tile) + row) * atlas.width() + atlas.column(tile) + column);
        });
    }

    std::unique_ptr<ImageBasis> basis(const std::vector<float>& image, const DetailCoding& coding) const override {
        const TilePlaces places = {coded_.complex.view(), texels_, image.size() / 3};
        return std::make_unique<TileBasis>(image, places, shape_, coding);
    }

    std::vector<Vec3> decoded(std::vector<float> image, const Units& units, const FitFrame& frame, bool) override {
        const auto middle = static_cast<float>(1 << (units.bits - 1));
        std::vector<float> grids;
        grids.reserve(3 * texels_.size());
        for (const uint32_t t : texels_)
            for (size_t k = 0; k < 3; ++k) grids.push_back(image[3 * size_t{t} + k] - middle);
        const QuadComplex& complex = coded_.complex.view();
        const DetailCoding coding = detail_coding_of(units);
        std::vector<float> found;
        if (shape_.is_sharp)
            (void)quantize_tiles<TilesSharp>(
                complex, shape_, analyse_tiles<TilesSharp>(complex, std::move(grids), shape_.exponent), coding, &found);
        else
            (void)quantize_tiles<Tiles97>(
                complex, shape_, analyse_tiles<Tiles97>(complex, std::move(grids), shape_.exponent), coding, &found);
        std::vector<Vec3> positions(image.size() / 3, Vec3(Vec3::Zero()));
        for (size_t i = 0; i < texels_.size(); ++i) {
            Vec3& p = positions[texels_[i]];
            for (size_t k = 0; k < 3; ++k)
                p[static_cast<int>(k)] =
                    double{units.origin[k]} + double{units.step} * double{found[3 * i + k] + middle};
        }
        return frame.into(positions);
    }

  private:
    CodedComplex coded_;
    TileShape shape_;
    std::vector<uint32_t> texels_;  // per sample of the tiles of the code
};

}  // namespace

Result<std::unique_ptr<FitCodec>> tile_fit_codec(const TileImage& image) {
    GIM_TRY(complex, complex_of(image.quads, image.vertices));
    return std::unique_ptr<FitCodec>(std::make_unique<TileFitCodec>(image, complex.view()));
}

Result<void> take_positions(const std::vector<Vec3>& atlas_positions, TileImage& image) {
    GIM_TRY(complex, complex_of(image.quads, image.vertices));
    const uint32_t side = 1u << image.exponent;
    const TileSamples samples(complex.view(), side);
    const TileAtlas atlas(complex.view().tiles, side);
    image.positions.resize(samples.count());
    for (uint32_t t = 0; t < complex.view().tiles; ++t) {
        for (uint32_t row = 0; row <= side; ++row) {
            for (uint32_t column = 0; column <= side; ++column)
                image.positions[samples.at(t, row, column)] =
                    atlas_positions[size_t{atlas.row(t) + row} * atlas.width() + atlas.column(t) + column];
        }
    }
    return {};
}

}  // namespace gim
