// Triangle mesh -> .gim: the driver. Its lines are the stages; those of one surface are in single_chart.cpp, those that
// every kind of input shares in finish_encoding.cpp.
#include <tbb/task_arena.h>

#include <exception>
#include <string>

#include "encoder/clean.h"
#include "encoder/finish_encoding.h"
#include "encoder/result.h"
#include "encoder/single_chart.h"
#include "encoder/stage_clock.h"

namespace gim {

namespace {

Result<Encoded> run_stages(const TriangleMesh& input, const EncodeOptions& options, const Progress& progress) {
    StageClock clock(progress);
    Encoded encoded;
    EncodeReport& report = encoded.report;
    report.input_vertices = input.positions.size();
    report.input_triangles = input.triangles.size();

    clock.begin(Stage::kClean);
    GIM_TRY(cleaned, clean(input));
    report.welded_vertices = cleaned.report.welded_vertices;
    report.removed_triangles = cleaned.report.degenerate_triangles + cleaned.report.duplicate_triangles;
    report.topology = cleaned.report.topology;

    GIM_TRY(chart, make_geometry_image(cleaned.mesh, options, clock));
    report.cut_length = chart.cut_length;
    report.stretch_efficiency = chart.stretch_efficiency;
    report.flipped_triangles = chart.flipped_triangles;
    report.folds = chart.folds;
    report.folds_before_fit = chart.folds_before_fit;

    return finish_encoding({&chart.image, 1}, std::move(cleaned.mesh), options, clock, std::move(encoded));
}

}  // namespace

Result<Encoded> encode(const TriangleMesh& mesh, const EncodeOptions& options, const Progress& progress) {
    GIM_TRY(checked, check_options(options));
    (void)checked;
    return guarded(options.threads, [&] { return run_stages(mesh, options, progress); });
}

}  // namespace gim
