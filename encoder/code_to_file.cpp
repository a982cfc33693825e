#include "encoder/code_to_file.h"

#include <utility>
#include <vector>

#include "encoder/code/assemble_file.h"
#include "encoder/code/decode_surface.h"
#include "encoder/code/level_report.h"
#include "encoder/planes/make_planes.h"
#include "encoder/rate_search.h"
#include "encoder/surface/compare_meshes.h"

namespace gim {

Result<Encoded> code_to_file(LayoutImages& images, Original original, const EncodeOptions& options,
                             const Contest& contest, StageClock& clock, EncodeReport report) {
    Encoded encoded{{}, std::move(report)};
    images.describe(encoded.report);
    const ReferenceSurface surface(std::move(original.surface), options.threads);
    CompareOptions compare_options;
    compare_options.threads = options.threads;
    compare_options.normals = compare_options.defects = true;

    CodingParameters parameters;
    const PlaneMaker plane_maker(surface.mesh(), original.input, options);
    if (plane_maker.wants_any()) {
        clock.begin(Stage::kPlanes);
        parameters.planes = plane_maker.make(images);
    }

    clock.begin(Stage::kCode);
    parameters.bits = options.bits;
    parameters.base_side = options.node_side;
    parameters.level_psnr = true;
    parameters.wide_origin = original.frame.is_moved;
    GIM_TRY(bytes, search_rate(images, parameters, options, contest, surface, clock));
    encoded.bytes = std::move(bytes);

    clock.begin(Stage::kCompare);
    GIM_TRY(comparison, compare_file(encoded.bytes, surface, compare_options));
    encoded.report.error = comparison;
    encoded.report.folds = comparison.defects->folded_faces;
    GIM_TRY(levels, measure_levels(encoded.bytes, surface, comparison, options.threads));
    encoded.report.levels = std::move(levels);
    GIM_TRY(info, read_own_info(encoded.bytes));
    encoded.bytes = set_level_psnr(encoded.bytes, psnr_of_levels(encoded.report.levels, info.level_count));
    GIM_TRY(planes, plane_maker.measure(encoded.bytes));
    encoded.report.planes = std::move(planes);
    clock.end();

    const Vec3& origin = original.frame.origin;
    if (original.frame.is_moved) encoded.bytes = move_origin(encoded.bytes, {origin.x(), origin.y(), origin.z()});
    move_out_of(original.frame, encoded.report);
    describe_file(encoded.bytes, encoded.report);
    encoded.report.times = clock.times();
    encoded.report.seconds = clock.seconds();
    return encoded;
}

}  // namespace gim
