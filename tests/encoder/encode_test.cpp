// The whole way: mesh -> .gim -> mesh.
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <cstring>
#include <limits>

#include "corpus/corpus.h"
#include "encoder/code/decode_surface.h"
#include "gim/decoder.h"
#include "gim/encoder.h"
#include "tests/encoder/decoded_topology.h"
#include "tests/models.h"

namespace gim {
namespace {

EncodeOptions small_options() {
    EncodeOptions options;
    options.side = 65;
    options.rate.kind = RateTarget::Kind::kLossless;
    options.fit = FitStrength::kOff;
    options.density = false;
    return options;
}

// At every level that the file says it can close, the decoded surface has the input's topology.
void expect_topology_at_every_level(const Encoded& encoded, const std::string& name) {
    const auto coarsest = coarsest_level(encoded.bytes);
    ASSERT_TRUE(coarsest.ok()) << name;
    for (uint32_t level = 0; level <= coarsest.value(); ++level) {
        expect_topology(encoded, level, name);
    }
}

TEST(Encode, EverySurfaceOfTheCorpusComesBackWithItsTopology) {
    for (const corpus::CorpusEntry& entry : corpus::corpus().connected()) {
        const TriangleMesh mesh = entry.mesh();
        if (mesh.triangles.size() > 6000) continue;  // the stage tests take the large ones
        const auto encoded = encode(mesh, small_options());
        ASSERT_TRUE(encoded.ok()) << entry.name << ": " << encoded.error().message;
        EXPECT_EQ(encoded.value().report.flipped_triangles, 0u) << entry.name;
        EXPECT_GT(encoded.value().report.error.psnr, 35) << entry.name;
        expect_topology_at_every_level(encoded.value(), entry.name);
    }
}

TEST(Encode, ASquareTooSmallForTheCutGivesWayToTheNextWithAWarning) {
    EncodeOptions options = small_options();
    options.side = 9;
    for (const RateTarget& rate :
         {RateTarget{RateTarget::Kind::kLossless, 0}, RateTarget{RateTarget::Kind::kPsnr, 30}}) {
        options.rate = rate;
        const auto encoded = encode(corpus::plate_with_holes(12, 2), options);
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        EXPECT_GT(encoded.value().report.side, 9u);
        ASSERT_EQ(encoded.value().report.warnings.size(), 1u);
        EXPECT_NE(encoded.value().report.warnings[0].find("9 x 9"), std::string::npos);
        expect_topology_at_every_level(encoded.value(), "plate");
    }
}

TEST(Encode, TooFewSamplesForTheChartsGiveWayToMoreWithAWarning) {
    EncodeOptions options;
    options.layout = Layout::kMcgim;
    options.samples = 1000;
    options.charts = 60;
    options.rate.kind = RateTarget::Kind::kLossless;
    const auto encoded = encode(corpus::melted_tori(8, 24), options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_GT(encoded.value().report.samples, 1000u);
    ASSERT_EQ(encoded.value().report.warnings.size(), 1u);
    expect_topology_at_every_level(encoded.value(), "tori");
}

TEST(Encode, EachComponentBecomesAnImageAsDenseAsTheOthers) {
    // A sphere, and another of a quarter of its radius beside it.
    TriangleMesh both = corpus::sphere(16);
    const TriangleMesh one = both;
    const auto base = static_cast<uint32_t>(both.positions.size());
    for (const auto& p : one.positions) both.positions.push_back({0.25 * p[0] + 5, 0.25 * p[1], 0.25 * p[2]});
    for (const auto& t : one.triangles) both.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
    for (const RateTarget& rate :
         {RateTarget{RateTarget::Kind::kLossless, 0}, RateTarget{RateTarget::Kind::kQuality, 50}}) {
        EncodeOptions options = small_options();
        options.rate = rate;
        const auto encoded = encode(both, options);
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        EXPECT_EQ(encoded.value().report.images, 2u);
        EXPECT_EQ(encoded.value().report.side, 65u);
        gim_info info;
        const std::vector<uint8_t>& bytes = encoded.value().bytes;
        ASSERT_EQ(gim_read_info(bytes.data(), bytes.size(), nullptr, &info), GIM_OK);
        gim_level_info shape;
        ASSERT_EQ(gim_read_level_info(&info, bytes.data(), bytes.size(), 1, 0, &shape), GIM_OK);
        EXPECT_EQ(shape.side, 17u);
        expect_topology_at_every_level(encoded.value(), "two spheres");
    }
}

TEST(Encode, PiecesOfTheCorpusComeBackWithTheirTopology) {
    const auto encoded = encode(corpus::corpus().named("four-pieces").mesh(), small_options());
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_EQ(encoded.value().report.images, 4u);
    expect_topology_at_every_level(encoded.value(), "four-pieces");
}

TEST(Encode, LevelsAreMeasuredAndToldInTheHeader) {
    const TriangleMesh mesh = corpus::torus(60, 30, 1, 0.4);
    const auto encoded = encode(mesh, small_options());
    ASSERT_TRUE(encoded.ok());
    const std::vector<uint8_t>& bytes = encoded.value().bytes;
    const std::vector<LevelReport>& levels = encoded.value().report.levels;
    gim_info info;
    ASSERT_EQ(gim_read_info(bytes.data(), bytes.size(), nullptr, &info), GIM_OK);
    ASSERT_EQ(levels.size(), 3u);  // 65, 33, 17
    CompareOptions options;
    options.defects = true;
    for (uint32_t level = 0; level < levels.size(); ++level) {
        const auto comparison = compare(mesh, as_input(decode_surface(bytes, level).value()), options);
        ASSERT_TRUE(comparison.ok());
        EXPECT_NEAR(levels[level].psnr, comparison.value().psnr, 0.1);
        const double rms = levels[level].rms_error, largest = levels[level].max_error;
        EXPECT_GE(largest, rms);
        EXPECT_GE(info.level_rms_error[level], rms);
        EXPECT_LE(info.level_rms_error[level], 1.08 * rms);
        EXPECT_GE(info.level_max_error[level], largest);
        EXPECT_LE(info.level_max_error[level], 1.08 * largest);
        EXPECT_NEAR(20 * std::log10(comparison.value().diagonal / rms), levels[level].psnr, 1e-6);
        EXPECT_EQ(levels[level].width, (64u >> level) + 1);
        gim_level_info shape;
        ASSERT_EQ(gim_read_level_info(&info, bytes.data(), bytes.size(), 0, level, &shape), GIM_OK);
        EXPECT_EQ(levels[level].prefix_bytes, shape.prefix_size);
        EXPECT_EQ(levels[level].vertices, shape.vertex_count);
        EXPECT_EQ(levels[level].defects.folded_faces, comparison.value().defects->folded_faces);
        EXPECT_NEAR(levels[level].defects.normals_p99, comparison.value().defects->normals_p99, 1);
    }
    EXPECT_EQ(info.level_rms_error[3], 0.0f);
}

// Asks to stop at the n-th call, for one n after the other.
TEST(Encode, ProgressMayStopTheRunAtAnyOfItsCalls) {
    const TriangleMesh mesh = corpus::torus(24, 12, 1, 0.4);
    for (const Layout layout : {Layout::kGim, Layout::kMcgim, Layout::kTiles, Layout::kAuto}) {
        SCOPED_TRACE(static_cast<int>(layout));
        EncodeOptions options = small_options();
        options.layout = layout;
        options.side = 17;
        options.samples = 1000;
        options.rate = {RateTarget::Kind::kPsnr, 40};
        size_t calls = 0;
        const auto whole = encode(mesh, options, [&](Stage, double) { return ++calls > 0; });
        ASSERT_TRUE(whole.ok()) << whole.error().message;
        ASSERT_GT(calls, 5u);
        for (size_t last = 1; last <= calls; last += 1 + calls / 7) {
            size_t heard = 0;
            Stage stage = Stage::kInput;
            const auto stopped = encode(mesh, options, [&](Stage at, double) {
                stage = at;
                return ++heard < last;
            });
            ASSERT_FALSE(stopped.ok());
            EXPECT_TRUE(stopped.error().is_cancelled);
            EXPECT_EQ(stopped.error().stage, stage);
            EXPECT_EQ(heard, last);  // it is not asked again
        }
    }
    EXPECT_FALSE(encode({}, {}, [](Stage, double) { return true; }).error().is_cancelled);
}

constexpr gim_box kEmptyBox = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};

void include(const float* low, const float* high, gim_box* box) {
    for (size_t k = 0; k < 3; ++k) {
        box->low[k] = std::min(box->low[k], low[k]);
        box->high[k] = std::max(box->high[k], high[k]);
    }
}

// The least box of decoded positions of all levels of an image.
gim_box least_box(const std::vector<uint8_t>& bytes, uint32_t image) {
    gim_box least = kEmptyBox;
    Decoder decoder;
    EXPECT_EQ(decoder.open(bytes), GIM_OK);
    DecoderLevel level;
    for (uint32_t l = 0; decoder.read_level(image, l, &level) == GIM_OK; ++l) {
        std::vector<float> positions(level.vertex_count * size_t{3});
        EXPECT_EQ(decoder.mesh(level, {positions, {}, {}, {}}), GIM_OK);
        for (size_t i = 0; i < positions.size(); i += 3) include(&positions[i], &positions[i], &least);
    }
    return least;
}

void expect_tight_boxes(const std::vector<uint8_t>& bytes) {
    gim_info info;
    ASSERT_EQ(gim_read_info(bytes.data(), bytes.size(), nullptr, &info), GIM_OK);
    const uint32_t index = info.index_size;  // is enough
    ASSERT_EQ(gim_read_info(bytes.data(), index, nullptr, &info), GIM_OK);
    ASSERT_EQ(info.has_boxes, 1u);
    const float cell = 1.001f * info.step * static_cast<float>(1u << info.bits) / 256;
    gim_box all = kEmptyBox;
    for (uint32_t image = 0; image < info.image_count; ++image) {
        gim_box box;
        ASSERT_EQ(gim_read_box(&info, bytes.data(), index, image, &box), GIM_OK);
        const gim_box least = least_box(bytes, image);
        for (size_t k = 0; k < 3; ++k) {
            EXPECT_LE(box.low[k], least.low[k]);
            EXPECT_GT(box.low[k], least.low[k] - cell);
            EXPECT_GE(box.high[k], least.high[k]);
            EXPECT_LT(box.high[k], least.high[k] + cell);
        }
        include(box.low, box.high, &all);
        gim_level_info level;
        ASSERT_EQ(gim_read_level_info(&info, bytes.data(), bytes.size(), image, 0, &level), GIM_OK);
        EXPECT_EQ(std::memcmp(&level.box, &box, sizeof box), 0);
        EXPECT_EQ(level.max_error, info.level_max_error[0]);
        EXPECT_EQ(level.rms_error, info.level_rms_error[0]);
    }
    EXPECT_EQ(std::memcmp(&all, &info.box, sizeof all), 0);
    EXPECT_EQ(gim_read_box(&info, bytes.data(), index, info.image_count, &all), GIM_BAD_ARGUMENT);
}

TEST(Encode, BoxesHoldEveryLevelOfTheirImageAndLittleMore) {
    for (const double shift : {0.0, 3e6}) {
        TriangleMesh mesh = corpus::corpus().named("four-pieces").mesh();
        for (auto& p : mesh.positions) p[0] += shift;
        for (const Layout layout : {Layout::kGim, Layout::kMcgim, Layout::kTiles}) {
            SCOPED_TRACE(static_cast<int>(layout));
            EncodeOptions options = small_options();
            options.layout = layout;
            options.samples = 4000;
            options.fit = FitStrength::kOff;
            const auto encoded = encode(mesh, options);
            ASSERT_TRUE(encoded.ok()) << encoded.error().message;
            expect_tight_boxes(encoded.value().bytes);
        }
    }
}

TEST(Encode, ObserverSeesStatesWhoseMapsFitTheirMeshes) {
    EncodeOptions options = small_options();
    options.density = true;
    options.fit = FitStrength::kStiff;
    std::vector<std::string> names;
    const auto watched = encode(corpus::limbed_blob(24), options, {}, [&](const Snapshot& state) {
        names.push_back(state.name);
        EXPECT_EQ(state.uv.size(), state.mesh.positions.size()) << state.name;
        EXPECT_FALSE(state.cut.empty()) << state.name;
        for (const auto& edge : state.cut) EXPECT_LT(std::max(edge[0], edge[1]), state.mesh.positions.size());
        for (const auto& p : state.uv) EXPECT_LE(std::max(std::abs(p[0]), std::abs(p[1])), 1 + 1e-9) << state.name;
    });
    ASSERT_TRUE(watched.ok()) << watched.error().message;
    ASSERT_GE(names.size(), 5u);
    EXPECT_EQ(names.front(), "cut-00");
    EXPECT_EQ(names.back(), "image-fitted");
    EXPECT_EQ(watched.value().bytes,
              encode(corpus::limbed_blob(24), options).value().bytes);  // watching changes nothing
}

TEST(Encode, LossyFilesKeepTheTopologyToo) {
    EncodeOptions options = small_options();
    options.rate = {RateTarget::Kind::kQuality, 30};
    for (const char* name : {"torus-576", "limbs", "annulus-512"}) {
        const corpus::CorpusEntry entry = corpus::corpus().named(name);
        ASSERT_EQ(entry.name, name);
        const auto encoded = encode(entry.mesh(), options);
        ASSERT_TRUE(encoded.ok()) << name;
        expect_topology_at_every_level(encoded.value(), name);
    }
}

TEST(Encode, PsnrTargetIsMetAndNotByMuch) {
    EncodeOptions options = small_options();
    const TriangleMesh mesh = corpus::torus(60, 30, 1, 0.4);
    // Below, a single coefficient, or a fold that is repaired, is worth more than 0.3 dB.
    for (const double target : {55.0, 60.0}) {
        options.rate = {RateTarget::Kind::kPsnr, target};
        const auto encoded = encode(mesh, options);
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        EXPECT_GE(encoded.value().report.error.psnr, target);
        EXPECT_LE(encoded.value().report.error.psnr, target + 0.3);
    }
}

TEST(Encode, PsnrOutOfReachIsAnErrorThatNamesTheBest) {
    EncodeOptions options = small_options();
    options.side = 17;
    options.rate = {RateTarget::Kind::kPsnr, 120};
    const auto encoded = encode(corpus::torus(60, 30, 1, 0.4), options);
    ASSERT_FALSE(encoded.ok());
    EXPECT_NE(encoded.error().message.find("out of reach"), std::string::npos);
}

TEST(Encode, ByteBudgetIsKeptAndUsed) {
    EncodeOptions options = small_options();
    for (const double budget : {800.0, 2000.0}) {
        options.rate = {RateTarget::Kind::kBytes, budget};
        const auto encoded = encode(corpus::torus(60, 30, 1, 0.4), options);
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        EXPECT_LE(static_cast<double>(encoded.value().bytes.size()), budget);
        EXPECT_GE(static_cast<double>(encoded.value().bytes.size()), 0.98 * budget);
    }
    options.rate = {RateTarget::Kind::kBytes, 20};
    EXPECT_FALSE(encode(corpus::torus(60, 30, 1, 0.4), options).ok());
}

TEST(Encode, TheNodeGridFollowsASmallSize) {
    for (const uint32_t side : {5u, 9u, 17u}) {
        for (const uint32_t node_side : {5u, 17u, 33u}) {
            EncodeOptions options = small_options();
            options.side = side;
            options.node_side = node_side;
            const auto encoded = encode(corpus::sphere(6), options);
            ASSERT_TRUE(encoded.ok()) << side << ", " << node_side << ": " << encoded.error().message;
            EXPECT_EQ(encoded.value().report.side, side);
            EXPECT_LE(encoded.value().report.node_side, side);
        }
    }
}

// The least size is a fact about mesh and options, not about the request.
TEST(Encode, BudgetsThatAreTooSmallNameOneLeastSize) {
    for (const FitStrength fit : {FitStrength::kOff, FitStrength::kAuto}) {
        EncodeOptions options = small_options();
        options.side = 17;
        options.fit = fit;
        const auto told = [&](double budget) {
            options.rate = {RateTarget::Kind::kBytes, budget};
            const auto encoded = encode(corpus::torus(60, 30, 1, 0.4), options);
            EXPECT_FALSE(encoded.ok()) << budget;
            const std::string message = encoded.ok() ? "" : encoded.error().message;
            return std::stod("0" + message.substr(std::min(message.size(), message.find(" has ") + 5)));
        };
        const double least = told(1);
        EXPECT_GT(least, 20);
        EXPECT_EQ(told(50), least);
        options.rate = {RateTarget::Kind::kBytes, least};
        const auto encoded = encode(corpus::torus(60, 30, 1, 0.4), options);
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        EXPECT_LE(static_cast<double>(encoded.value().bytes.size()), least);
    }
}

// Samples are fitted to the codec; the rate search includes that fit.
EncodeOptions coded_options() {
    EncodeOptions options = small_options();
    options.fit = FitStrength::kAuto;
    options.density = true;
    return options;
}
TriangleMesh bumpy_sphere() { return corpus::roughened(corpus::sphere(20), 0.01, 4); }

TEST(Encode, PsnrTargetIsMetByFilesFittedToTheCodec) {
    const TriangleMesh mesh = bumpy_sphere();
    EncodeOptions options = coded_options();
    for (const double target : {55.0, 58.0}) {  // in files below 200 bytes, one coefficient may be worth 1 dB
        options.rate = {RateTarget::Kind::kPsnr, target};
        const auto encoded = encode(mesh, options);
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        const auto comparison = compare(mesh, as_input(decode_surface(encoded.value().bytes, 0).value()), {});
        EXPECT_GE(comparison.value().psnr, target);
        EXPECT_LE(comparison.value().psnr, target + 0.3);
        EXPECT_NEAR(comparison.value().psnr, encoded.value().report.error.psnr, 1e-9);
        expect_topology_at_every_level(encoded.value(), "bumpy sphere");
    }
}

TEST(Encode, OfTwoSidesTheBetterFileIsKept) {
    const TriangleMesh mesh = bumpy_sphere();
    for (const RateTarget rate : {RateTarget{RateTarget::Kind::kPsnr, 50}, RateTarget{RateTarget::Kind::kBytes, 900}}) {
        EncodeOptions options = coded_options();
        if (rate.kind == RateTarget::Kind::kBytes) options.fit = FitStrength::kStiff;  // one fit takes long enough
        options.rate = rate;
        const Encoded full = encode(mesh, options).value();
        EncodeOptions smaller = options;
        smaller.side = options.side / 2 + 1;
        smaller.node_side = std::min(smaller.node_side, smaller.side);
        const Encoded half = encode(mesh, smaller).value();
        options.try_smaller_sides = true;
        const Encoded kept = encode(mesh, options).value();
        const bool half_is_better = rate.kind == RateTarget::Kind::kPsnr
                                        ? half.bytes.size() < full.bytes.size()
                                        : half.report.error.psnr > full.report.error.psnr;
        EXPECT_EQ(kept.bytes, half_is_better ? half.bytes : full.bytes);
        EXPECT_EQ(kept.report.side, half_is_better ? smaller.side : options.side);
    }
}

// A fit to a too coarse quantizer heaps samples up for good. So the search has to begin anew. A byte of such files is
// worth several decibels: their sizes, not their PSNR, tell whether the search came near.
TEST(Encode, TargetsOfAHandfulOfBytesAreMetByFilesFittedToTheCodec) {
    const TriangleMesh mesh = bumpy_sphere();
    EncodeOptions options = coded_options();
    std::vector<size_t> bytes;
    for (const double target : {35.0, 50.0}) {
        options.rate = {RateTarget::Kind::kPsnr, target};
        const auto encoded = encode(mesh, options);
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        EXPECT_GE(encoded.value().report.error.psnr, target);
        bytes.push_back(encoded.value().bytes.size());
    }
    constexpr size_t kErrorsAndBox = 12;  // what the header tells engines; it does not depend on the search
    EXPECT_LT(bytes[0], 120 + kErrorsAndBox);
    EXPECT_LT(bytes[1], 200 + kErrorsAndBox);
    EXPECT_LT(bytes[0] + 20, bytes[1]);
}

TEST(Encode, ByteBudgetIsKeptAndUsedByFilesFittedToTheCodec) {
    const TriangleMesh mesh = bumpy_sphere();
    EncodeOptions options = coded_options();
    for (const double budget : {500.0, 2000.0}) {
        options.rate = {RateTarget::Kind::kBytes, budget};
        const auto encoded = encode(mesh, options);
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        EXPECT_LE(static_cast<double>(encoded.value().bytes.size()), budget);
        EXPECT_GE(static_cast<double>(encoded.value().bytes.size()), 0.98 * budget);
    }
}

TEST(Encode, FittingToTheCodecMakesFilesSmallerThanTheStiffFit) {
    const TriangleMesh mesh = bumpy_sphere();
    EncodeOptions options = coded_options();
    options.rate = {RateTarget::Kind::kPsnr, 55};
    const auto coded = encode(mesh, options);
    options.fit = FitStrength::kStiff;
    const auto stiff = encode(mesh, options);
    ASSERT_TRUE(coded.ok() && stiff.ok());
    EXPECT_LT(double(coded.value().bytes.size()), 0.9 * double(stiff.value().bytes.size()));
}

TEST(Encode, SameBytesAtAnyThreadCountWhereSamplesAreFittedToTheCodec) {
    EncodeOptions options = coded_options();
    options.rate = {RateTarget::Kind::kQuality, 60};
    const TriangleMesh mesh = bumpy_sphere();
    options.threads = 1;
    const auto one = encode(mesh, options);
    options.threads = 2;
    const auto two = encode(mesh, options);
    ASSERT_TRUE(one.ok() && two.ok());
    EXPECT_EQ(one.value().bytes, two.value().bytes);
}

TEST(Encode, SameBytesAtAnyThreadCount) {
    EncodeOptions options = small_options();
    options.fit = FitStrength::kStiff;
    options.density = true;
    const TriangleMesh mesh = corpus::limbed_blob(24);
    options.threads = 1;
    const auto one = encode(mesh, options);
    options.threads = 2;
    const auto two = encode(mesh, options);
    ASSERT_TRUE(one.ok()) << one.error().message;
    ASSERT_TRUE(two.ok()) << two.error().message;
    EXPECT_EQ(one.value().bytes, two.value().bytes);
}

TEST(Encode, LosslessSamplesAreWithinHalfAStep) {
    // The same samples with many and with few bits: no coordinate may differ by more than the steps allow.
    EncodeOptions options = small_options();
    options.bits = 8;
    const TriangleMesh mesh = corpus::sphere(12);
    const auto coarse = encode(mesh, options);
    options.bits = 20;
    const auto fine = encode(mesh, options);
    ASSERT_TRUE(coarse.ok() && fine.ok());
    const Mesh a = decode_surface(coarse.value().bytes, 0).value(), b = decode_surface(fine.value().bytes, 0).value();
    ASSERT_EQ(a.positions.size(), b.positions.size());
    gim_info info_a, info_b;
    ASSERT_EQ(gim_read_info(coarse.value().bytes.data(), coarse.value().bytes.size(), nullptr, &info_a), GIM_OK);
    ASSERT_EQ(gim_read_info(fine.value().bytes.data(), fine.value().bytes.size(), nullptr, &info_b), GIM_OK);
    const double allowed = 0.5 * (double(info_a.step) + double(info_b.step)) + 1e-6;
    for (size_t v = 0; v < a.positions.size(); ++v)
        EXPECT_LE((a.positions[v] - b.positions[v]).cwiseAbs().maxCoeff(), allowed);
}

TEST(Encode, BrokenMeshesAreRefusedWithWords) {
    for (const corpus::CorpusEntry& entry : corpus::corpus().broken()) {
        const auto encoded = encode(entry.mesh(), small_options());
        if (encoded.ok()) continue;  // repaired by cleaning: duplicates, orientation
        EXPECT_GT(encoded.error().message.size(), 20u) << entry.name;
    }
    const auto nothing = encode({}, small_options());
    EXPECT_FALSE(nothing.ok());
    TriangleMesh nan = corpus::sphere(4);
    nan.positions[7][1] = std::numeric_limits<double>::quiet_NaN();
    const auto refused = encode(nan, small_options());
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find('7'), std::string::npos) << "names the vertex";
}

TEST(Encode, WrongOptionsAreRefused) {
    const TriangleMesh mesh = corpus::sphere(4);
    const auto refused = [&](const auto& change) {
        EncodeOptions options = small_options();
        change(options);
        return !encode(mesh, options).ok();
    };
    EXPECT_TRUE(refused([](EncodeOptions& o) { o.side = 256; }));
    EXPECT_TRUE(refused([](EncodeOptions& o) { o.node_side = 128; }));
    EXPECT_TRUE(refused([](EncodeOptions& o) { o.bits = 7; }));
    EXPECT_TRUE(refused([](EncodeOptions& o) { o.bits = 21; }));
    EXPECT_TRUE(refused([](EncodeOptions& o) { o.rate = {RateTarget::Kind::kQuality, 101}; }));
    EXPECT_TRUE(refused([](EncodeOptions& o) { o.rate = {RateTarget::Kind::kPsnr, std::nan("")}; }));
    EXPECT_TRUE(refused([](EncodeOptions& o) { o.rate = {RateTarget::Kind::kBytes, 0}; }));
}

TEST(Encode, FitBringsTheSurfaceNearer) {
    EncodeOptions options = small_options();
    const TriangleMesh mesh = corpus::limbed_blob(24);
    const auto plain = encode(mesh, options);
    options.fit = FitStrength::kLoose;
    const auto fitted = encode(mesh, options);
    ASSERT_TRUE(plain.ok() && fitted.ok());
    EXPECT_GT(fitted.value().report.error.psnr, plain.value().report.error.psnr + 1);
    expect_topology_at_every_level(fitted.value(), "fitted");
}

TEST(Encode, FoldsAreThoseOfTheDecodedSurface) {
    EncodeOptions options = small_options();
    options.rate = {RateTarget::Kind::kQuality, 20};  // so coarse that the quantizer folds faces over
    const TriangleMesh mesh = corpus::limbed_blob(24);
    const auto encoded = encode(mesh, options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    const EncodeReport& report = encoded.value().report;
    CompareOptions with_defects;
    with_defects.defects = true;
    const auto compared = compare(mesh, as_input(decode_surface(encoded.value().bytes, 0).value()), with_defects);
    ASSERT_TRUE(compared.ok());
    EXPECT_GT(report.folds, 0u);
    EXPECT_EQ(report.folds, compared.value().defects->folded_faces);
    EXPECT_EQ(report.folds, report.error.defects->folded_faces);
    EXPECT_EQ(report.folds, report.levels[0].defects.folded_faces);
}

TEST(EncodeModels, SmallModelsKeepTheirTopologyAtEveryLevel) {
    const struct {
        const char* name;
        double genus;
        uint64_t loops;
    } models[] = {{"eight", 2, 0}, {"block", 3, 0}, {"mask-holes", 0, 7}, {"rocker-arm", 1, 0}};
    for (const auto& model : models) {
        const auto mesh = read_model(std::string(GIM_MODELS_DIR) + "/" + model.name + ".ply");
        if (!mesh) GTEST_SKIP() << "the development models are not there";
        EncodeOptions options = small_options();
        options.side = 129;
        const auto encoded = encode(*mesh, options);
        ASSERT_TRUE(encoded.ok()) << model.name << ": " << encoded.error().message;
        EXPECT_EQ(encoded.value().report.topology.genus, model.genus) << model.name;
        EXPECT_EQ(encoded.value().report.topology.boundary_loops, model.loops) << model.name;
        expect_topology_at_every_level(encoded.value(), model.name);
    }
}

}  // namespace
}  // namespace gim
