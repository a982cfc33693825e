#include "encoder/fit/fold_repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "corpus/corpus.h"
#include "encoder/base/parallel.h"
#include "encoder/charts/close_chart_seams.h"
#include "encoder/charts/make_charts.h"
#include "encoder/charts/write_charts.h"
#include "encoder/code/code_bands.h"
#include "encoder/code/decode_surface.h"
#include "encoder/code/file_units.h"
#include "encoder/fit/fold_changes.h"
#include "encoder/squares/make_square.h"
#include "encoder/squares/write_squares.h"
#include "encoder/surface/clean.h"
#include "encoder/surface/defects.h"
#include "format/fuse.h"
#include "format/ring.h"
#include "gim/decoder.hpp"
#include "tests/encoder/grid_images.h"

namespace gim {
namespace {

constexpr uint32_t kSide = 65;
constexpr RepairEffort kOnePass = {1, kLastRepair.fold, kLastRepair.turn},
                       kNoPass = {0, kLastRepair.fold, kLastRepair.turn};

// A square image, the surface that it was made from, and its seams.
struct Square {
    Mesh mesh;
    SquareImage image;
    SeamTable seams;
};

// Limbs are covered by few samples in one direction. A coarse quantizer folds them.
Square limbs() {
    Square square;
    square.mesh = clean(corpus::limbed_blob(24)).value().mesh;
    EncodeOptions options;
    options.side = kSide;
    options.fit = FitStrength::kOff;
    options.density = false;
    StageClock clock({});
    square.image = make_square(square.mesh, options, {}, clock).value().image;
    square.seams = file_seams(square.image);
    return square;
}

// Nothing folds unless a test spoils it.
Square smooth_torus() {
    Square square{mesh_of(corpus::torus(120, 60, 0.7, 0.3)), torus_image(kSide, 0.7, 0.3), {}};
    square.seams = file_seams(square.image);
    return square;
}

Units units_for(const SquareImage& image, double quantizer) {
    Units units = units_of({&image, 1}, 12);
    units.quantizer = quantizer_in_range(quantizer);
    return units;
}

Pyramid<int32_t> quantized(const Square& square, const Units& units) {
    Pyramid<float> bands =
        analyse<Irreversible97>(to_units<float>(square.image.positions, units), kSide, &square.seams);
    subtract_middle(&bands, units.bits);
    return quantize_bands(bands, detail_coding_of(units), &square.seams).bands;
}

CloseSeams fusing(const SeamTable& seams) {
    return [&seams](std::vector<float>& image) {
        std::vector<uint32_t> classes(ring_length(kSide));
        ring_classes(seams, kSide, classes);
        const uint32_t count = 1 + *std::max_element(classes.begin(), classes.end());
        std::vector<float> sums(3 * classes.size()), outer(3 * classes.size()), inner(3 * classes.size());
        std::vector<uint32_t> first(classes.size()), members(classes.size());
        fuse(kSide, classes.data(), count, image.data(),
             {sums.data(), first.data(), members.data(), outer.data(), inner.data()});
    };
}

FoldRepair repair_of(const Square& square) {
    return FoldRepair(square.image, square.mesh, {CodedPart{kSide, kSide, 0, 0, &square.seams, {}}},
                      fusing(square.seams));
}

// What a person gets from such bands: the decoded file.
struct Outcome {
    size_t folds = 0, bytes = 0;
    double psnr = 0;
};

Outcome outcome_of(const std::vector<uint8_t>& bytes, const Mesh& reference) {
    const Mesh decoded = decode_surface(bytes, 0).value();
    const ClosestPointTree tree(reference);
    const std::vector<uint8_t> folded = find_folded_faces(decoded, reference, tree, 1);
    const Comparison comparison = compare_file(bytes, ReferenceSurface(reference), {.samples = 50000}).value();
    return {static_cast<size_t>(std::count(folded.begin(), folded.end(), 1)), bytes.size(), comparison.psnr};
}

// Codes the bands as they are.
std::vector<uint8_t> file_with(const Square& square, const Units& units, const Pyramid<int32_t>& bands) {
    CodingParameters parameters;
    parameters.lossless = false;
    parameters.quantizer = double{units.quantizer};
    parameters.units = units;
    parameters.repair = [&](size_t, std::span<Pyramid<int32_t>> of_file, const Units&) { of_file[0] = bands; };
    return squares_writer({&square.image, 1}, parameters).value().write(double{units.quantizer});
}

bool same(const Pyramid<int32_t>& a, const Pyramid<int32_t>& b) {
    if (a.base != b.base || a.levels.size() != b.levels.size()) return false;
    for (size_t e = 0; e < a.levels.size(); ++e) {
        if (a.levels[e].horizontal != b.levels[e].horizontal || a.levels[e].vertical != b.levels[e].vertical ||
            a.levels[e].diagonal != b.levels[e].diagonal)
            return false;
    }
    return true;
}

// Sums over several quantizers, because single images are a few folds off with any change of the encoder.
struct Balance {
    Outcome before, after;

    void add(const Outcome& unrepaired, const Outcome& repaired) {
        EXPECT_LE(static_cast<double>(repaired.bytes), 1.03 * static_cast<double>(unrepaired.bytes));
        EXPECT_GE(repaired.psnr, unrepaired.psnr - 0.3);
        before.folds += unrepaired.folds;
        after.folds += repaired.folds;
        before.bytes += unrepaired.bytes;
        after.bytes += repaired.bytes;
    }
};

TEST(FoldRepair, HardlyAFoldOfTheQuantizerIsLeftAndLittleIsPaidForThat) {
    const Square square = limbs();
    Balance balance;
    for (const double quantizer : {8.0, 16.0, 32.0, 48.0}) {
        const Units units = units_for(square.image, quantizer);
        Pyramid<int32_t> bands = quantized(square, units);
        const Outcome before = outcome_of(file_with(square, units, bands), square.mesh);
        repair_of(square).repair({&bands, 1}, units, kLastRepair);
        balance.add(before, outcome_of(file_with(square, units, bands), square.mesh));
    }
    ASSERT_GT(balance.before.folds, 80u);
    EXPECT_LE(balance.after.folds, balance.before.folds / 8);
    EXPECT_LE(static_cast<double>(balance.after.bytes), 1.01 * static_cast<double>(balance.before.bytes));
}

TEST(FoldRepair, OnePassAlreadyRemovesMuch) {
    const Square square = limbs();
    const Units units = units_for(square.image, 32);
    const Pyramid<int32_t> start = quantized(square, units);
    Pyramid<int32_t> bands = start;
    repair_of(square).repair({&bands, 1}, units, kNoPass);
    EXPECT_TRUE(same(bands, start));
    repair_of(square).repair({&bands, 1}, units, kOnePass);
    const size_t before = outcome_of(file_with(square, units, start), square.mesh).folds,
                 after = outcome_of(file_with(square, units, bands), square.mesh).folds;
    EXPECT_LE(after, before * 6 / 10);
}

// Spoils details of the finest bands here and there.
void spoil(Pyramid<int32_t>& bands, int32_t by) {
    const LevelBands finest = bands_of(bands, bands.steps() - 1);
    for (uint32_t i = 3; i < 30; i += 5) {
        finest.horizontal.row(i)[3 * (30 - i) + 1] += by;
        finest.vertical.row(31 - i)[3 * i + 2] -= by;
    }
}

TEST(FoldRepair, FoldsMadeByHandAreRemoved) {
    const Square square = smooth_torus();
    const Units units = units_for(square.image, 16);
    ASSERT_EQ(outcome_of(file_with(square, units, quantized(square, units)), square.mesh).folds, 0u);
    for (const int32_t by : {2, 3}) {
        Pyramid<int32_t> bands = quantized(square, units);
        spoil(bands, by);
        const Outcome spoilt = outcome_of(file_with(square, units, bands), square.mesh);
        repair_of(square).repair({&bands, 1}, units, kLastRepair);
        const Outcome repaired = outcome_of(file_with(square, units, bands), square.mesh);
        ASSERT_GT(spoilt.folds, 10u) << by;
        EXPECT_LE(repaired.folds, spoilt.folds / 10) << by;
        EXPECT_LE(repaired.bytes, spoilt.bytes) << by;
        EXPECT_GT(repaired.psnr, spoilt.psnr) << by;
    }
}

TEST(FoldRepair, AnImageWithoutFoldsIsLeftAsItIs) {
    const Square square = smooth_torus();
    for (const double quantizer : {2.0, 16.0}) {
        const Units units = units_for(square.image, quantizer);
        Pyramid<int32_t> bands = quantized(square, units);
        const Pyramid<int32_t> before = bands;
        repair_of(square).repair({&bands, 1}, units, kLastRepair);
        EXPECT_TRUE(same(bands, before)) << quantizer;
    }
}

TEST(FoldRepair, ThreadsAndRepetitionChangeNothing) {
    const Square square = limbs();
    const Units units = units_for(square.image, 16);
    std::vector<Pyramid<int32_t>> results;
    for (const uint32_t threads : {1u, 2u, 2u}) {
        results.push_back(quantized(square, units));
        with_threads(threads, [&] { repair_of(square).repair({&results.back(), 1}, units, kLastRepair); });
    }
    EXPECT_FALSE(same(results[0], quantized(square, units)));
    EXPECT_TRUE(same(results[0], results[1]));
    EXPECT_TRUE(same(results[0], results[2]));
}

// So the same quantizer gives the same bytes when a search tries it again.
// A finder that has followed many changes must find what a new one finds, and each must cost what it said.
TEST(FoldChanges, AFinderFollowsTheStateAndTellsWhatAChangeCosts) {
    const Square square = limbs();
    const Units units = units_for(square.image, 40);
    Pyramid<int32_t> bands = quantized(square, units);
    const ImageParts parts{
        square.image.gluing, {CodedPart{kSide, kSide, 0, 0, &square.seams, {}}}, fusing(square.seams)};
    std::vector<DetailResponses> responses;
    responses.emplace_back(kSide, kSide, true);
    PartsImage image(parts, responses, {&bands, 1}, units);
    const FitFrame frame(square.mesh);
    const FitReference reference(Mesh{frame.into(square.mesh.positions), square.mesh.triangles});
    const double front = front_side(frame.into(square.image.positions), square.image.gluing, reference);
    std::vector<uint32_t> nearest(2 * square.image.gluing.kind.size(), kNone);
    FoldState state({square.image.gluing, reference, frame, front}, image, kLastRepair, nearest);
    ASSERT_FALSE(state.steep_cells().empty());
    FoldChanges finder(state);
    size_t changes = 0;
    for (const uint32_t cell : state.steep_cells()) {
        if (state.cost(cell) == 0) continue;
        const auto best = finder.best_around(cell, 1, 3, 1), by_another = FoldChanges(state).best_around(cell, 1, 3, 1);
        ASSERT_EQ(best.empty(), by_another.empty());
        if (best.empty()) continue;
        ASSERT_EQ(best[0].place, by_another[0].place);
        ASSERT_EQ(best[0].cost, by_another[0].cost);
        ASSERT_NEAR(finder.cost_of(best[0]), best[0].cost, 1e-6);
        const PlaceInPart& p = best[0].place;
        const CodedImage::Levels trial = image.decode_changed(p, best[0].component, best[0].by);
        image.band(p).row(p.row)[3 * p.column + best[0].component] += best[0].by;
        ASSERT_EQ(image.decode(), trial);
        const WeightedSamples samples = finder.reach_of(p).samples;
        EXPECT_FALSE(state.move(samples, best[0].shift).empty());
        ++changes;
    }
    EXPECT_GT(changes, 5u);
}

TEST(FoldRepair, EarlierCallsChangeNothing) {
    const Square square = limbs();
    const Units units = units_for(square.image, 32);
    Pyramid<int32_t> first = quantized(square, units);
    FoldRepair repair = repair_of(square);
    repair.repair({&first, 1}, units, kLastRepair);
    for (int call = 0; call < 3; ++call) {
        Pyramid<int32_t> again = quantized(square, units);
        repair.repair({&again, 1}, units, kLastRepair);
        EXPECT_TRUE(same(again, first)) << call;
    }
}

// A fold of many cells needs one coarse detail, not many fine ones.
TEST(FoldRepair, FoldsOfSpoiledCoarseDetailsAreRemoved) {
    const Square square = limbs();
    const Units units = units_for(square.image, 64);
    Pyramid<int32_t> bands = quantized(square, units);
    repair_of(square).repair({&bands, 1}, units, kLastRepair);
    const size_t least = outcome_of(file_with(square, units, bands), square.mesh).folds;
    const LevelBands coarse = bands_of(bands, bands.steps() - 4);
    for (const uint32_t i : {0u, 1u, 2u, 3u}) {
        coarse.horizontal.row(i)[3 * i + 1] += 3;
        coarse.vertical.row(i)[3 * (3 - i) + 2] -= 3;
    }
    const size_t before = outcome_of(file_with(square, units, bands), square.mesh).folds;
    for (int call = 0; call < 4; ++call) repair_of(square).repair({&bands, 1}, units, kLastRepair);
    const size_t after = outcome_of(file_with(square, units, bands), square.mesh).folds;
    ASSERT_GT(before, least + 15);
    EXPECT_LE(after, least + 2);
}

// The coder leaves out details that a mate stands for. Changes to them would be lost.
void expect_copies_untouched(const Square& square, Pyramid<int32_t>& bands) {
    uint32_t copies = 0;
    for (uint32_t step = 1; step <= bands.steps(); ++step) {
        const OwnSharedRim rim(&square.seams, bands.columns_at(step));
        rim.view().for_each_copy([&](Orientation orientation, uint32_t row, uint32_t column) {
            const int32_t* detail = bands_of(bands, step - 1).of(orientation).row(row) + 3 * size_t{column};
            for (size_t k = 0; k < 3; ++k) EXPECT_EQ(detail[k], 0);
            ++copies;
        });
    }
    EXPECT_GT(copies, 50u);
}

TEST(FoldRepair, SeamsStayClosedAndADecoderSeesWhatTheRepairSees) {
    const Square square = limbs();
    const Units units = units_for(square.image, 48);
    Pyramid<int32_t> bands = quantized(square, units);
    FoldRepair repair = repair_of(square);
    repair.repair({&bands, 1}, units, kLastRepair);
    expect_copies_untouched(square, bands);
    const std::vector<Vec3> samples = repair.samples(repair.levels({&bands, 1}, units), units);
    for (const auto& members : square.image.gluing.shared) {
        for (const uint32_t v : members) EXPECT_EQ(samples[v], samples[members[0]]);
    }
    const std::vector<uint8_t> bytes = file_with(square, units, bands);
    Decoder decoder;
    DecoderLevel level;
    ASSERT_EQ(decoder.open(bytes), GIM_OK);
    ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    std::vector<float> grid(3 * samples.size());
    ASSERT_EQ(decoder.grid(level, {grid, {}, {}, {}}), GIM_OK);
    const FitFrame frame(square.mesh);
    for (size_t i = 0; i < samples.size(); ++i) {
        const Vec3 decoded(double{grid[3 * i]}, double{grid[3 * i + 1]}, double{grid[3 * i + 2]});
        ASSERT_LT((frame.out_of(samples[i]) - decoded).norm(), 0.05 * double{units.step}) << i;
    }
    for (const auto& members : square.image.gluing.shared) {
        for (const uint32_t v : members) {
            for (size_t k = 0; k < 3; ++k) EXPECT_EQ(grid[3 * v + k], grid[3 * members[0] + k]);
        }
    }
}

// A repair of charts. Keeps references to charts.
FoldRepair repair_of(const ChartLevels& charts, const Mesh& mesh) {
    std::vector<CodedPart> parts;
    for (size_t c = 0; c < charts.charts.size(); ++c) {
        const ChartBox& box = charts.charts[c];
        parts.push_back({box.columns, box.rows, box.atlas_column, box.atlas_row, nullptr, charts.defined[c]});
    }
    return FoldRepair(charts.image, mesh, std::move(parts),
                      [&charts](std::vector<float>& image) { close_chart_seams(charts, image); });
}

TEST(FoldRepair, ChartsAreRepairedTogether) {
    const Mesh mesh = clean(corpus::limbed_blob(24)).value().mesh;
    EncodeOptions options;
    options.layout = Layout::kMcgim;
    options.samples = 2500;
    options.fit = FitStrength::kOff;
    options.density = false;
    StageClock clock({});
    EncodeReport report;
    const ChartLevels charts = make_charts(mesh, options, options.samples, clock, {}, report).value();
    Balance balance;
    for (const double quantizer : {16.0, 32.0, 64.0}) {
        CodingParameters parameters;
        parameters.lossless = false;
        parameters.quantizer = quantizer;
        const Outcome before = outcome_of(charts_writer(charts, parameters).value().write(quantizer), mesh);
        FoldRepair repair = repair_of(charts, mesh);
        std::vector<Vec3> seen;
        parameters.repair = [&](size_t, std::span<Pyramid<int32_t>> bands, const Units& units) {
            repair.repair(bands, units, kLastRepair);
            seen = repair.samples(repair.levels(bands, units), units);
        };
        balance.add(before, outcome_of(charts_writer(charts, parameters).value().write(quantizer), mesh));
        for (const auto& members : charts.image.gluing.shared) {
            for (const uint32_t v : members) EXPECT_EQ(seen[v], seen[members[0]]);
        }
    }
    ASSERT_GT(balance.before.folds, 30u);
    EXPECT_LE(balance.after.folds, balance.before.folds / 6);
}

}  // namespace
}  // namespace gim
