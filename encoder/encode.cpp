// Triangle mesh -> .gim: the driver. Its lines are the stages; those of the layouts are in single_chart.cpp and
// multi_chart.cpp, those that every kind of input shares in finish_encoding.cpp.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/charts/encode_charts.h"
#include "encoder/choose_layout.h"
#include "encoder/code/rate_control.h"
#include "encoder/finish_encoding.h"
#include "encoder/planes/input_colors.h"
#include "encoder/squares/encode_squares.h"
#include "encoder/squares/square_images.h"
#include "encoder/surface/clean.h"

namespace gim {

namespace {

Result<Encoded> run_squares(const Mesh& mesh, const TriangleMesh& input, const EncodeOptions& options,
                            StageClock& clock, const Observer& observer, Encoded encoded, CutPreferences& preferences) {
    GIM_TRY(squares, make_square_images(mesh, options, clock, observer, encoded.report, preferences));
    const CodingJob job = code_squares(std::move(squares), options, clock, encoded.report);
    return finish_encoding(job, mesh, input, options, clock, std::move(encoded));
}

// Up to here half the side was better on some of the models that were measured (spec/rationale.md).
constexpr double kMostPsnrOfSmallerSides = 71;
constexpr uint32_t kLeastSideToHalve = 65;

bool is_better(const Encoded& a, const Encoded& b, const RateTarget& rate) {
    return rate.kind == RateTarget::Kind::kBytes ? a.report.error.psnr > b.report.error.psnr
                                                 : a.bytes.size() < b.bytes.size();
}

EncodeOptions halved(EncodeOptions options) {
    options.side = (options.side - 1) / 2 + 1;
    options.node_side = std::min(options.node_side, options.side);
    return options;
}

bool may_halve(const EncodeOptions& options) {
    const bool is_fine = options.rate.kind == RateTarget::Kind::kPsnr && options.rate.value > kMostPsnrOfSmallerSides;
    return options.try_smaller_sides && options.side >= kLeastSideToHalve && is_searched(options.rate) && !is_fine;
}

// The file of the side that is asked for or, where that is allowed and the target coarse, of the half of it as long as halving
// makes it better. The half comes first: cuts are chosen there, in a quarter of the time. Pictures are those of the first.
template <class Run>
Result<Encoded> best_of_sides(const Run& run, EncodeOptions options, const StageClock& clock,
                              const Observer& observer) {
    if (!may_halve(options)) return run(options, observer);
    const auto improves = [&](const Result<Encoded>& now, const Result<Encoded>& best) {
        return now.ok() && (!best.ok() || is_better(now.value(), best.value(), options.rate));
    };
    const EncodeOptions whole = options;
    options = halved(options);
    auto best = run(options, observer);
    auto of_whole = run(whole, {});
    if (!best.ok() || improves(of_whole, best)) {
        best = std::move(of_whole);
    } else {
        while (options.side >= kLeastSideToHalve) {
            options = halved(options);
            auto half = run(options, {});
            if (!improves(half, best)) break;
            best = std::move(half);
        }
    }
    if (best.ok()) {
        best.value().report.times = clock.times();
        best.value().report.seconds = clock.seconds();
    }
    return best;
}

Result<Encoded> run_stages(const TriangleMesh& input, const EncodeOptions& options, const Progress& progress,
                           const Observer& observer) {
    StageClock clock(progress);
    Encoded encoded;
    EncodeReport& report = encoded.report;
    report.input_vertices = input.positions.size();
    report.input_triangles = input.triangles.size();

    if (std::string c = appearance_complaint(input); !c.empty()) return Error{Stage::kInput, std::move(c)};

    clock.begin(Stage::kClean);
    GIM_TRY(cleaned, clean(input, {.require_connected = false}));
    report.welded_vertices = cleaned.report.welded_vertices;
    report.removed_triangles = cleaned.report.degenerate_triangles + cleaned.report.duplicate_triangles;
    report.topology = cleaned.report.topology;

    const Layout layout =
        options.layout == Layout::kAuto ? choose_layout(cleaned.mesh, options, clock) : options.layout;
    if (layout == Layout::kMcgim) {
        GIM_TRY(charts, make_charts(cleaned.mesh, options, clock, observer, report));
        const CodingJob job = code_charts(charts, report);
        return finish_encoding(job, std::move(cleaned.mesh), input, options, clock, std::move(encoded));
    }
    CutPreferences preferences;  // chosen at the first side
    return best_of_sides(
        [&](const EncodeOptions& o, const Observer& shown) {
            return run_squares(cleaned.mesh, input, o, clock, shown, encoded, preferences);
        },
        options, clock, observer);
}

}  // namespace

Result<Encoded> encode(const TriangleMesh& mesh, const EncodeOptions& options, const Progress& progress,
                       const Observer& observer) {
    GIM_TRY(checked, check_options(options));
    (void)checked;
    return guarded(options.threads, [&] { return run_stages(mesh, options, progress, observer); });
}

}  // namespace gim
