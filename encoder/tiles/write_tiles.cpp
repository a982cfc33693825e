#include "encoder/tiles/write_tiles.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "encoder/code/file_units.h"
#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/code_tiles.h"
#include "format/tile_atlas.h"
#include "format/tile_lifting.h"

namespace gim {
namespace {

Error error(std::string message) { return {Stage::kWrite, std::move(message)}; }

Result<void> check(const TileImage& image, const CodingParameters& p) {
    GIM_CHECK(check_bits(p.bits));
    if (image.quads.empty()) return error("no tile to write");
    if (image.quads.size() > kMostTiles)
        return error(std::to_string(image.quads.size()) + " tiles: a file holds at most " + std::to_string(kMostTiles));
    if (image.exponent < 1 || image.exponent > kMostTileExponent)
        return error("exponent " + std::to_string(image.exponent) + ": choose 1 to " +
                     std::to_string(kMostTileExponent));
    const TileAtlas atlas(static_cast<uint32_t>(image.quads.size()), 1u << image.exponent);
    if (atlas.samples() > kMostTileSamples) return error("too many samples: choose fewer tiles or a smaller exponent");
    if (!image.sharp.empty() && image.sharp.size() != 4 * image.quads.size())
        return error("sharp edges are not told for each side of each tile");
    for (size_t s = 0; s < image.positions.size(); ++s) {
        if (!is_codable(image.positions[s]))
            return error("sample " + std::to_string(s) + ": position is not a finite number of reasonable size");
    }
    return {};
}

Result<void> check_count(const TileImage& image, const QuadComplex& complex) {
    const uint32_t count = TileSamples(complex, 1u << image.exponent).count();
    if (image.positions.size() == count) return {};
    return error(std::to_string(image.positions.size()) + " positions, not one for each of the " +
                 std::to_string(count) + " samples");
}

// The positions as the code orders them: per tile its grid.
std::vector<Vec3> coded_positions(const TileImage& image, const CodedComplex& coded, const QuadComplex& complex) {
    std::vector<Vec3> positions;
    for (const uint32_t s : coded_samples(coded, complex, 1u << image.exponent))
        positions.push_back(image.positions[s]);
    return positions;
}

Units units_of(std::span<const Vec3> grids, uint32_t side, uint32_t bits) {
    const std::span<const Vec3> parts[1] = {grids};
    Units units = units_of_box(parts, bits);
    CellArea area;
    const size_t size = size_t{side + 1} * (side + 1);
    for (size_t at = 0; at < grids.size(); at += size) area.add(grids.subspan(at, size), {}, side + 1, side + 1);
    area.set_details(&units);
    return units;
}

// Codes the tiles' part of a file.
class TileLevelCoder final : public LevelCoder {
  public:
    TileLevelCoder(const TileImage& image, const QuadComplex& complex, const CodingParameters& parameters,
                   RepairTiles repair);

    Header header() const override { return header_; }
    std::vector<uint8_t> seam_payload() const override { return coded_.payload; }
    std::vector<std::vector<uint8_t>> code_levels(const Header& header) const override;

  private:
    TilePyramid<int32_t> quantized(const Header& header) const;

    Header header_;
    CodedComplex coded_;
    TilePyramid<int32_t> lossless_;
    TilePyramid<float> lossy_;
    RepairTiles repair_;
};

// The coarsest level has about as many samples as a square of the base side.
uint32_t levels_of(uint32_t tiles, uint32_t exponent, uint32_t base_side) {
    const uint64_t least = uint64_t{base_side - 1} * (base_side - 1);
    uint32_t levels = 1;
    while (levels < exponent && (uint64_t{tiles} << (2 * (exponent - levels))) >= least) ++levels;
    return levels;
}

template <class Sample>
void subtract_middle(std::vector<Sample>& base, uint32_t bits) {
    for (Sample& v : base) v -= static_cast<Sample>(1 << (bits - 1));
}

TileLevelCoder::TileLevelCoder(const TileImage& image, const QuadComplex& complex, const CodingParameters& parameters,
                               RepairTiles repair)
    : coded_(code_complex(image, complex)), repair_(parameters.lossless ? RepairTiles() : std::move(repair)) {
    const QuadComplex& view = coded_.complex.view();
    header_.layout = FileLayout::kTiles;
    header_.coding = parameters.lossless ? Coding::kLossless : Coding::kLossy;
    header_.tiles = shape_of(image, view, parameters.lossless);
    header_.level_count = levels_of(view.tiles, image.exponent, std::max(parameters.base_side, 3u));
    const std::vector<Vec3> grids = coded_positions(image, coded_, complex);
    const bool has_units = !parameters.lossless && parameters.units;
    static_cast<Units&>(header_) =
        has_units ? *parameters.units : units_of(grids, 1u << image.exponent, parameters.bits);
    header_.quantizer = 0;
    if (parameters.lossless) {
        header_.tangential = header_.cell_area = 0;
        lossless_ = analyse_tiles<Tiles53>(view, to_units<int32_t>(grids, header_), image.exponent);
        subtract_middle(lossless_.base, header_.bits);
    } else {
        std::vector<float> units = to_units<float>(grids, header_);
        lossy_ = image.is_sharp ? analyse_tiles<TilesSharp>(view, std::move(units), image.exponent)
                                : analyse_tiles<Tiles97>(view, std::move(units), image.exponent);
        subtract_middle(lossy_.base, header_.bits);
    }
}

TilePyramid<int32_t> TileLevelCoder::quantized(const Header& header) const {
    if (header.coding == Coding::kLossless) return lossless_;
    const DetailCoding coding = detail_coding_of(header);
    const QuadComplex& complex = coded_.complex.view();
    return header.tiles.is_sharp ? quantize_tiles<TilesSharp>(complex, header.tiles, lossy_, coding)
                                 : quantize_tiles<Tiles97>(complex, header.tiles, lossy_, coding);
}

std::vector<std::vector<uint8_t>> TileLevelCoder::code_levels(const Header& header) const {
    TilePyramid<int32_t> pyramid = quantized(header);
    if (repair_) repair_(pyramid, header);
    return code_tiles(coded_.complex.view(), pyramid, header.level_count, tile_kind_of(header));
}

}  // namespace

TileShape shape_of(const TileImage& image, const QuadComplex& complex, bool lossless) {
    return {complex.tiles,
            complex.vertices,
            complex.edges - 2 * complex.tiles,
            image.exponent,
            image.is_sharp && !lossless,
            !image.sharp.empty()};
}

Result<FileWriter> tiles_writer(const TileImage& image, const CodingParameters& parameters, RepairTiles repair) {
    GIM_CHECK(check(image, parameters));
    GIM_TRY(complex, complex_of(image.quads, image.vertices));
    GIM_CHECK(check_count(image, complex.view()));
    return FileWriter(std::make_unique<TileLevelCoder>(image, complex.view(), parameters, std::move(repair)),
                      parameters);
}

Result<std::vector<uint8_t>> write_tiles(const TileImage& image, const CodingParameters& parameters) {
    GIM_TRY(writer, tiles_writer(image, parameters));
    return writer.write(parameters.quantizer);
}

Result<Units> tile_units(const TileImage& image, uint32_t bits) {
    GIM_TRY(complex, complex_of(image.quads, image.vertices));
    GIM_CHECK(check_count(image, complex.view()));
    return units_of(coded_positions(image, code_complex(image, complex.view()), complex.view()), 1u << image.exponent,
                    bits);
}

}  // namespace gim
