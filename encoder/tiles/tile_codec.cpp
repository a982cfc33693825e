#include "encoder/tiles/tile_codec.h"

#include <utility>

#include "encoder/tiles/tile_basis.h"
#include "encoder/tiles/tile_pyramid.h"
#include "encoder/tiles/write_tiles.h"
#include "format/tile_atlas.h"

namespace gim {

namespace {

// Where a tile of the code has its samples in the atlas of the image.
std::vector<uint32_t> texels_of(const CodedComplex& coded, uint32_t side) {
    const uint32_t tiles = coded.complex.view().tiles;
    const TileAtlas atlas(tiles, side);
    std::vector<uint32_t> texels;
    texels.reserve(tiles * size_t{side + 1} * (side + 1));
    for_each_coded_sample(coded, side, [&](uint32_t tile, uint32_t row, uint32_t column) {
        texels.push_back((atlas.row(tile) + row) * atlas.width() + atlas.column(tile) + column);
    });
    return texels;
}

template <class Wavelet>
std::vector<float> decoded_grids(const QuadComplex& complex, const TileShape& shape, std::vector<float> grids,
                                 const Units& units) {
    TilePyramid<float> pyramid = analyse_tiles<Wavelet>(complex, std::move(grids), shape.exponent);
    const auto middle = static_cast<float>(1 << (units.bits - 1));
    for (float& v : pyramid.base) v -= middle;
    std::vector<float> decoded;
    (void)quantize_tiles<Wavelet>(complex, shape, pyramid, detail_coding_of(units), &decoded);
    for (float& v : decoded) v += middle;
    return decoded;
}

}  // namespace

TileCodec::TileCodec(CodedComplex coded, std::vector<uint32_t> texels, const TileShape& shape, size_t texel_count,
                     const FitFrame& frame)
    : coded_(std::move(coded)), texels_(std::move(texels)), shape_(shape), texel_count_(texel_count), frame_(frame) {}

Result<TileCodec> TileCodec::make(const TileImage& tiles, const FitFrame& frame) {
    GIM_TRY(complex, complex_of(tiles.quads, tiles.vertices));
    CodedComplex coded = code_complex(tiles, complex.view());
    const TileShape shape = shape_of(tiles, coded.complex.view(), false);
    const uint32_t side = 1u << tiles.exponent;
    std::vector<uint32_t> texels = texels_of(coded, side);
    return TileCodec(std::move(coded), std::move(texels), shape, TileAtlas(shape.tiles, side).samples(), frame);
}

std::unique_ptr<ImageBasis> TileCodec::basis(const std::vector<float>& image, const DetailCoding& coding) const {
    return std::make_unique<TileBasis>(image, TilePlaces{coded_.complex.view(), texels_, texel_count_}, shape_, coding);
}

std::vector<Vec3> TileCodec::decoded(const std::vector<float>& image, const Units& units, bool) {
    std::vector<float> grids;
    grids.reserve(3 * texels_.size());
    for (const uint32_t texel : texels_)
        for (size_t k = 0; k < 3; ++k) grids.push_back(image[3 * size_t{texel} + k]);
    const QuadComplex& complex = coded_.complex.view();
    const std::vector<float> coded = shape_.is_sharp
                                         ? decoded_grids<TilesSharp>(complex, shape_, std::move(grids), units)
                                         : decoded_grids<Tiles97>(complex, shape_, std::move(grids), units);
    std::vector<Vec3> positions(texel_count_, Vec3::Zero());
    for (size_t i = 0; i < texels_.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            positions[texels_[i]][k] = double{units.origin[static_cast<size_t>(k)]} +
                                       double{units.step} * double{coded[3 * i + static_cast<size_t>(k)]};
    }
    return frame_.into(positions);
}

}  // namespace gim
