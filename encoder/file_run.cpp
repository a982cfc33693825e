#include "encoder/file_run.h"

#include <utility>
#include <vector>

#include "encoder/code/assemble_file.h"
#include "encoder/code/decode_surface.h"
#include "encoder/code/level_report.h"
#include "encoder/code/measure_boxes.h"
#include "encoder/planes/labels.h"
#include "encoder/planes/make_planes.h"
#include "encoder/rate_search.h"

namespace gim {

struct FileRun::Impl {
    Impl(std::unique_ptr<LayoutImages> images, const Original& original, const EncodeOptions& options,
         StageClock& clock, EncodeReport report)
        : images_(std::move(images)),
          original_(original),
          options_(options),
          clock_(clock),
          report_(std::move(report)),
          plane_maker_(original_.surface.mesh(), original_.input, options_),
          search_(*images_, make_parameters(), options_, original_.surface, clock_) {}

    Result<Estimate> estimate(std::optional<double> near) {
        clock_.begin(Stage::kCode);
        return search_.estimate(near);
    }

    Result<Encoded> finish(const Contest& contest) {
        clock_.begin(Stage::kCode);
        GIM_TRY(bytes, search_.run(contest));
        if (images_->is_fitted_to_quantizer()) {
            clock_.begin(Stage::kPlanes);
            bytes = plane_maker_.renew(std::move(bytes), *images_);
        }
        if (has_labels(original_.input)) {
            clock_.begin(Stage::kPlanes);
            GIM_TRY(labels, cell_labels(bytes, original_.input, options_.threads));
            GIM_TRY(labelled, with_labels(bytes, labels));
            bytes = std::move(labelled);
        }
        Encoded encoded{std::move(bytes), std::move(report_)};
        images_->describe(encoded.report);
        GIM_CHECK(measure(encoded));
        clock_.end();

        const LocalFrame& frame = original_.frame;
        const Vec3& origin = frame.origin;
        if (frame.is_moved) encoded.bytes = move_origin(encoded.bytes, {origin.x(), origin.y(), origin.z()});
        move_out_of(frame, encoded.report);
        describe_file(encoded.bytes, encoded.report);
        return encoded;
    }

  private:
    CodingParameters make_parameters() {
        CodingParameters parameters;
        if (plane_maker_.wants_any()) {
            clock_.begin(Stage::kPlanes);
            parameters.planes = plane_maker_.make(*images_);
        }
        parameters.bits = options_.bits;
        parameters.base_side = options_.node_side;
        parameters.bounds = true;
        parameters.wide_origin = original_.frame.is_moved;
        return parameters;
    }

    // Compares the decoded levels and planes with the input, and stores what the levels reach.
    Result<void> measure(Encoded& encoded) {
        clock_.begin(Stage::kCompare);
        CompareOptions compare_options;
        compare_options.threads = options_.threads;
        compare_options.normals = compare_options.defects = true;
        GIM_TRY(comparison, compare_file(encoded.bytes, original_.surface, compare_options));
        encoded.report.error = comparison;
        encoded.report.folds = comparison.defects->folded_faces;
        GIM_TRY(levels, measure_levels(encoded.bytes, original_.surface, comparison, options_.threads));
        encoded.report.levels = std::move(levels);
        GIM_TRY(info, read_own_info(encoded.bytes));
        encoded.bytes = set_level_errors(encoded.bytes, errors_of_levels(encoded.report.levels, info.level_count));
        GIM_TRY(boxes, measure_boxes(encoded.bytes));
        encoded.bytes = set_boxes(encoded.bytes, boxes);
        GIM_TRY(planes, plane_maker_.measure(encoded.bytes));
        encoded.report.planes = std::move(planes);
        return {};
    }

    const std::unique_ptr<LayoutImages> images_;
    const Original original_;
    const EncodeOptions options_;
    StageClock& clock_;
    EncodeReport report_;
    const PlaneMaker plane_maker_;
    RateSearch search_;
};

FileRun::FileRun(std::unique_ptr<LayoutImages> images, const Original& original, const EncodeOptions& options,
                 StageClock& clock, EncodeReport report)
    : impl_(std::make_unique<Impl>(std::move(images), original, options, clock, std::move(report))) {}
FileRun::~FileRun() = default;

Result<Estimate> FileRun::estimate(std::optional<double> near) { return impl_->estimate(near); }
Result<Encoded> FileRun::finish(const Contest& contest) { return impl_->finish(contest); }

Result<Encoded> timed(Result<Encoded> encoded, StageClock& clock) {
    clock.end();
    if (encoded.ok()) {
        encoded.value().report.times = clock.times();
        encoded.value().report.seconds = clock.seconds();
    }
    return encoded;
}

}  // namespace gim
