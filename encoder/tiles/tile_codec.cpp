#include "encoder/tiles/tile_codec.h"

#include <utility>

#include "encoder/tiles/tile_basis.h"
#include "encoder/tiles/write_tiles.h"

namespace gim {

namespace {

template <class Wavelet>
TilePyramid<int32_t> quantized_grids(const QuadComplex& complex, const TileShape& shape, std::vector<float> grids,
                                     const Units& units) {
    TilePyramid<float> pyramid = analyse_tiles<Wavelet>(complex, std::move(grids), shape.exponent);
    const auto middle = static_cast<float>(1 << (units.bits - 1));
    for (float& v : pyramid.base) v -= middle;
    return quantize_tiles<Wavelet>(complex, shape, pyramid, detail_coding_of(units));
}

}  // namespace

TileCodec::TileCodec(CodedComplex coded, TileTexels texels, const TileShape& shape, const FitSetting& setting)
    : FitCodec(setting.gluing),
      coded_(std::move(coded)),
      texels_(std::move(texels)),
      shape_(shape),
      frame_(setting.frame),
      responses_(coded_.complex.view(), shape_, texels_.of_sample),
      passes_(setting.gluing, setting.reference, frame_, setting.front) {}

Result<std::unique_ptr<TileCodec>> TileCodec::make(const TileImage& tiles, const FitSetting& setting) {
    GIM_TRY(complex, complex_of(tiles.quads, tiles.vertices));
    CodedComplex coded = code_complex(tiles, complex.view());
    const TileShape shape = shape_of(tiles, coded.complex.view(), false);
    TileTexels texels = texels_of(coded, 1u << tiles.exponent);
    return std::unique_ptr<TileCodec>(new TileCodec(std::move(coded), std::move(texels), shape, setting));
}

CodedCoordinates TileCodec::coordinates(const std::vector<float>& image, const DetailCoding& coding) {
    const auto basis = std::make_shared<const TileBasis>(
        image, TilePlaces{coded_.complex.view(), texels_.of_sample, texels_.sample_at.size()}, shape_, coding);
    return {basis, basis->analyse(image)};
}

TilePyramid<int32_t> TileCodec::quantized(const std::vector<float>& image, const Units& units) const {
    std::vector<float> grids;
    grids.reserve(3 * texels_.of_sample.size());
    for (const uint32_t texel : texels_.of_sample)
        for (size_t k = 0; k < 3; ++k) grids.push_back(image[3 * size_t{texel} + k]);
    const QuadComplex& complex = coded_.complex.view();
    return shape_.is_sharp ? quantized_grids<TilesSharp>(complex, shape_, std::move(grids), units)
                           : quantized_grids<Tiles97>(complex, shape_, std::move(grids), units);
}

std::vector<Vec3> TileCodec::decoded(const std::vector<float>& image, const Units& units, bool mends_folds) {
    TilePyramid<int32_t> pyramid = quantized(image, units);
    if (mends_folds) repair(pyramid, units, kRepairBetween);
    const TileFoldImage coded(coded_.complex.view(), shape_, texels_, responses_, pyramid, units);
    return positions_of(coded.samples(coded.decode()), units, frame_);
}

void TileCodec::repair(TilePyramid<int32_t>& pyramid, const Units& units, const RepairEffort& effort) {
    TileFoldImage coded(coded_.complex.view(), shape_, texels_, responses_, pyramid, units);
    passes_.repair(coded, effort);
}

}  // namespace gim
