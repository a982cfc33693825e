// The repair of folds on tiles, as files get it.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "corpus/corpus.h"
#include "encoder/code/decode_surface.h"
#include "encoder/fit/fitter.h"
#include "encoder/surface/clean.h"
#include "encoder/surface/defects.h"
#include "encoder/tiles/make_tiles.h"
#include "encoder/tiles/tile_codec.h"
#include "encoder/tiles/write_tiles.h"
#include "format/detail_frame.h"
#include "tests/encoder/grid_images.h"

namespace gim {
namespace {

// Tiles of a surface, as sampled, and a codec that knows the surface. What it refers to stays in place.
struct Tiled {
    explicit Tiled(Mesh surface) : mesh(std::move(surface)), frame(mesh) {
        EncodeOptions options;
        options.tiles = 40;
        options.samples = 14000;
        options.fit = FitStrength::kOff;
        options.density = false;
        StageClock clock({});
        made = make_tiles(make_tileable(mesh, {}), mesh, options, clock).value();
        reference = std::make_unique<FitReference>(Mesh{frame.into(mesh.positions), mesh.triangles});
        const GridGluing& gluing = made.atlas.gluing;
        const double front = front_side(frame.into(made.atlas.positions), gluing, *reference);
        codec = std::move(TileCodec::make(made.tiles, {gluing, *reference, frame, front}).value());
    }
    Tiled(const Tiled&) = delete;
    Tiled& operator=(const Tiled&) = delete;

    std::vector<uint8_t> file(double quantizer, const RepairTiles& repair) const {
        CodingParameters parameters;
        parameters.lossless = false;
        parameters.units = tile_units(made.tiles, 12).value();
        return tiles_writer(made.tiles, parameters, repair).value().write(quantizer);
    }
    // At the price of squares.
    RepairTiles repair() const {
        return
            [this](TilePyramid<int32_t>& pyramid, const Units& units) { codec->repair(pyramid, units, kLastRepair); };
    }
    // As files have it.
    RepairTiles cheap_repair() const {
        return [this](TilePyramid<int32_t>& pyramid, const Units& units) { codec->repair(pyramid, units); };
    }

    Mesh mesh;
    FitFrame frame;
    MadeTiles made;
    std::unique_ptr<FitReference> reference;
    std::unique_ptr<TileCodec> codec;
};

// Limbs are covered by few samples in one direction. A coarse quantizer folds them.
Mesh limbs() { return clean(corpus::limbed_blob(24)).value().mesh; }

struct Outcome {
    size_t folds = 0, bytes = 0;
    double psnr = 0;
};
Outcome outcome_of(const std::vector<uint8_t>& bytes, const Mesh& reference) {
    const Mesh decoded = decode_surface(bytes, 0).value();
    const std::vector<uint8_t> folded = find_folded_faces(decoded, reference, ClosestPointTree(reference), 1);
    const Comparison comparison = compare_file(bytes, ReferenceSurface(reference), {.samples = 50000}).value();
    return {static_cast<size_t>(std::count(folded.begin(), folded.end(), 1)), bytes.size(), comparison.psnr};
}

// What a repair does to files of limbs at four quantizers.
struct Limits {
    size_t part;              // 1 / the folds that may stay
    double bytes, all_bytes;  // what a file and all of them may take, as a factor
    double psnr;              // what a file may lose, dB
};
void expect_fewer_folds(const Tiled& tiled, const RepairTiles& repair, const Limits& limits) {
    size_t folds_before = 0, folds_after = 0, bytes_before = 0, bytes_after = 0;
    for (const double quantizer : {8.0, 16.0, 32.0, 48.0}) {
        const Outcome before = outcome_of(tiled.file(quantizer, {}), tiled.mesh);
        const Outcome after = outcome_of(tiled.file(quantizer, repair), tiled.mesh);
        EXPECT_LE(static_cast<double>(after.bytes), limits.bytes * static_cast<double>(before.bytes)) << quantizer;
        EXPECT_GE(after.psnr, before.psnr - limits.psnr) << quantizer;
        folds_before += before.folds, folds_after += after.folds;
        bytes_before += before.bytes, bytes_after += after.bytes;
    }
    ASSERT_GT(folds_before, 80u);
    EXPECT_LE(folds_after, folds_before / limits.part);
    EXPECT_LE(static_cast<double>(bytes_after), limits.all_bytes * static_cast<double>(bytes_before));
}

TEST(TileRepair, MostFoldsOfTheQuantizerAreRemovedAndLittleIsPaidForThat) {
    const Tiled tiled(limbs());
    expect_fewer_folds(tiled, tiled.repair(), {4, 1.03, 1.015, 0.3});
}

TEST(TileRepair, FilesLoseHalfOfTheirFoldsForNextToNothing) {
    const Tiled tiled(limbs());
    expect_fewer_folds(tiled, tiled.cheap_repair(), {2, 1.01, 1.005, 0.05});
}

// Spoils details inside tiles and on their edges.
void spoil(TilePyramid<int32_t>& pyramid) {
    std::vector<int32_t>& finest = pyramid.details.back();
    for (size_t i = 100; i + 3 < finest.size(); i += 1003) finest[i / 3 * 3 + 1 + i % 2] += 3;
}

TEST(TileRepair, MostFoldsMadeByHandAreRemoved) {
    const Tiled tiled(mesh_of(corpus::torus(120, 60, 0.7, 0.3)));
    const auto repair = tiled.repair();
    const Outcome sound = outcome_of(tiled.file(16, {}), tiled.mesh);
    const auto spoilt_file = tiled.file(16, [](TilePyramid<int32_t>& pyramid, const Units&) { spoil(pyramid); });
    const Outcome spoilt = outcome_of(spoilt_file, tiled.mesh);
    const Outcome repaired = outcome_of(tiled.file(16,
                                                   [&](TilePyramid<int32_t>& pyramid, const Units& units) {
                                                       spoil(pyramid);
                                                       repair(pyramid, units);
                                                   }),
                                        tiled.mesh);
    ASSERT_EQ(sound.folds, 0u);
    ASSERT_GT(spoilt.folds, 10u);
    EXPECT_LE(repaired.folds, spoilt.folds / 5);
    EXPECT_LE(static_cast<double>(repaired.bytes), 1.02 * static_cast<double>(spoilt.bytes));
    EXPECT_GT(repaired.psnr, spoilt.psnr);
}

TEST(TileRepair, ASurfaceWithoutFoldsIsLeftAsItIs) {
    const Tiled tiled(mesh_of(corpus::torus(120, 60, 0.7, 0.3)));
    for (const double quantizer : {2.0, 16.0})
        EXPECT_EQ(tiled.file(quantizer, tiled.repair()), tiled.file(quantizer, {})) << quantizer;
}

TEST(TileRepair, EarlierCallsChangeNothing) {
    const Tiled tiled(limbs());
    const auto first = tiled.file(32, tiled.repair());
    (void)tiled.file(8, tiled.repair());
    EXPECT_EQ(tiled.file(32, tiled.repair()), first);
}

}  // namespace
}  // namespace gim
