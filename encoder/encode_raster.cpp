// The driver from an image of another program to a .gim file.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "encoder/base/guarded.h"
#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/check_options.h"
#include "encoder/clean_target.h"
#include "encoder/code/decode_surface.h"
#include "encoder/code/level_report.h"
#include "encoder/code/rate_target.h"
#include "encoder/file_run.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/raster/fit_raster.h"
#include "encoder/raster/glue_raster.h"
#include "encoder/raster/quantize_raster.h"
#include "encoder/raster/raster_surface.h"
#include "encoder/raster/write_raster.h"
#include "encoder/raster/zip_borders.h"
#include "encoder/surface/compare_meshes.h"
#include "gim/refit.h"

namespace gim {
namespace {

constexpr int kStepsPerOctave = 8;
constexpr double kFloatTolerance = 1e-6;  // diagonals
// Samples of a comparison: thousands of small images must not take as long as large ones.
constexpr size_t kSamplesPerTriangle = 16, kFewestSamples = 20000, kMostSamples = 500000;

using File = std::vector<uint8_t>;

// Positions in units, from the box's lower corner on.
std::vector<float> units_of(const std::vector<Vec3>& positions, const RasterScale& scale) {
    std::vector<float> units;
    for (const Vec3& p : positions) {
        for (int k = 0; k < 3; ++k)
            units.push_back(static_cast<float>((p[k] - scale.low[static_cast<size_t>(k)]) / double{scale.units.step}));
    }
    return units;
}

double weld_tolerance(const RasterImage& image, const std::vector<Vec3>& positions, const EncodeOptions& options) {
    if (!options.weld_tolerance && is_whole(image.type)) return 0;
    const Length length = options.weld_tolerance.value_or(Length{kFloatTolerance, true});
    if (!length.in_diagonals) return length.value;
    Vec3 low = Vec3::Constant(INFINITY), high = -low;
    for (size_t i = 0; i < positions.size(); ++i) {
        if (!image.defined[i]) continue;
        low = low.cwiseMin(positions[i]);
        high = high.cwiseMax(positions[i]);
    }
    return length.value * (high - low).norm();
}

// An image with its numbers and its surface.
struct Raster {
    const RasterImage* image;
    RasterScale scale;
    RasterGluing gluing;
    Mesh surface;
};

Raster with_surface(const RasterImage& image, RasterScale scale, RasterGluing gluing,
                    const std::vector<Vec3>& positions, const std::vector<float>& units) {
    open_crowded_edges(image.width, image.height, units, gluing);
    Mesh surface = raster_surface(gluing, raster_triangles(gluing, image.width, image.height, units), positions);
    return {&image, std::move(scale), std::move(gluing), std::move(surface)};
}

Result<Raster> glued(const RasterImage& image, const EncodeOptions& options) {
    GIM_TRY(scale, scale_raster(image, options.bits));
    const std::vector<Vec3> positions = raster_positions(image);
    const double tolerance = weld_tolerance(image, positions, options);
    RasterGluing gluing = glue_raster(image, positions, tolerance);
    const std::vector<float> units = units_of(positions, scale);
    zip_borders(image.width, image.height, units, positions, tolerance, gluing);
    Raster raster = with_surface(image, std::move(scale), std::move(gluing), positions, units);
    if (raster.surface.triangles.empty())
        return Error{Stage::kInput, "the mask leaves no surface: no cell of four samples has three that are defined"};
    return raster;
}

class RasterRun {
  public:
    // Keeps references to its arguments. A refitted image: the reference is the mesh, else the image's own surface.
    RasterRun(const Raster& raster, const ReferenceSurface& reference, bool is_refitted, const EncodeOptions& options)
        : image_(*raster.image),
          scale_(raster.scale),
          gluing_(raster.gluing),
          reference_(reference),
          is_refitted_(is_refitted),
          options_(options) {}

    // Never larger than the lossless file: on very smooth images rounding may cost more than it saves.
    Result<File> find_file() const {
        File exact = write_raster(image_, scale_, gluing_, 0);
        if (options_.rate.kind == RateTarget::Kind::kLossless) return exact;
        GIM_TRY(file, find_lossy_file(exact));
        return exact.size() <= file.size() ? std::move(exact) : std::move(file);
    }
    // Samples of the comparisons that decide and that are reported.
    uint32_t samples() const {
        const size_t wanted = kSamplesPerTriangle * reference_.mesh().triangles.size();
        return static_cast<uint32_t>(std::clamp<size_t>(wanted, kFewestSamples, kMostSamples));
    }
    Result<Comparison> compare(const File& file, uint32_t samples, bool defects) const {
        CompareOptions options;
        options.samples = samples;
        options.threads = options_.threads;
        options.defects = defects;
        return compare_file(file, reference_, options);
    }

  private:
    Result<File> find_lossy_file(const File& exact) const {
        const RateTarget rate = resolved_target(options_.rate, reference_.diagonal());
        if (rate.kind == RateTarget::Kind::kQuality)
            return write_raster(image_, scale_, gluing_, std::max(first_quantizer(rate, scale_.units.bits), 1.0));
        if (rate.kind == RateTarget::Kind::kBytes)
            return double(exact.size()) <= rate.value ? exact : within_bytes(rate.value);
        return within_error(rate, exact);
    }
    // Quantizers rise by equal factors from 1 on. The last one leaves two bits.
    double quantizer(int step) const { return std::exp2(double(step) / kStepsPerOctave); }
    int last_step() const { return kStepsPerOctave * (static_cast<int>(scale_.units.bits) - 2); }
    File file_at(int step) const { return write_raster(image_, scale_, gluing_, quantizer(step)); }

    // Returns the first step from which on `holds` is true, if it is once it has become so; last_step() + 1 if nowhere.
    template <class Holds>
    Result<int> first_step(const Holds& holds) const {
        int low = 0, high = last_step() + 1;
        while (low < high) {
            const int middle = (low + high) / 2;
            GIM_TRY(is_true, holds(middle));
            (is_true ? high : low) = is_true ? middle : middle + 1;
        }
        return low;
    }

    Result<File> within_bytes(double most) const {
        GIM_TRY(step, first_step([&](int k) { return Result<bool>(double(file_at(k).size()) <= most); }));
        if (step <= last_step()) return file_at(step);
        return Error{Stage::kCode, std::to_string(static_cast<uint64_t>(most)) +
                                       " bytes are too few: the smallest file of this image has " +
                                       std::to_string(file_at(last_step()).size())};
    }
    Result<File> within_error(const RateTarget& rate, const File& exact) const {
        const auto misses = [&](const File& file, uint32_t samples) -> Result<bool> {
            GIM_TRY(c, compare(file, samples, false));
            return rate.kind == RateTarget::Kind::kPsnr ? c.psnr < rate.value
                                                        : c.hausdorff > rate.value * reference_.diagonal();
        };
        GIM_TRY(step, first_step([&](int k) {
                    return misses(file_at(k), std::min(samples(), RateSearchValues::kTrialSamples));
                }));
        for (; step > 0; --step) {
            File file = file_at(step - 1);
            GIM_TRY(is_missed, misses(file, samples()));
            if (!is_missed) return file;
        }
        GIM_TRY(is_missed, misses(exact, samples()));
        if (!is_missed) return exact;
        return Error{Stage::kCode, reach_of(exact)};
    }
    // What to do if even the exact file misses the target.
    std::string reach_of(const File& exact) const {
        const std::string bits = std::to_string(scale_.units.bits) + " bits per coordinate";
        if (!is_refitted_) return "out of reach with " + bits + "; take more --bits";
        const Result<Comparison> best = compare(exact, samples(), false);
        if (!best.ok()) return best.error().message;
        char text[120];
        std::snprintf(text, sizeof text, " and so many samples: the fitted image has %.2f dB, at most %.3g away",
                      best.value().psnr, best.value().hausdorff);
        const bool is_loose = options_.fit == FitStrength::kLoose;
        return "out of reach with " + bits + text + (is_loose ? "" : "; a loose fit may come nearer (--fit loose)");
    }

    const RasterImage& image_;
    const RasterScale& scale_;
    const RasterGluing& gluing_;
    const ReferenceSurface& reference_;
    bool is_refitted_;
    const EncodeOptions& options_;
};

void describe_image(const Raster& raster, EncodeReport& report) {
    const RasterImage& image = *raster.image;
    const RasterGluing& gluing = raster.gluing;
    report.layout = Layout::kMcgim;
    report.images = 1;
    report.width = image.width;
    report.height = image.height;
    report.samples = uint64_t{image.width} * image.height;
    report.charts = gluing.pieces;
    report.defined_samples = gluing.defined;
    report.packing_efficiency = double(gluing.defined) / double(report.samples);
    report.border_samples = gluing.border;
    report.open_samples = gluing.open;
}

TopologySummary topology_of(const Mesh& surface) {
    TriangleMesh mesh;
    for (const Vec3& p : surface.positions) mesh.positions.push_back({p.x(), p.y(), p.z()});
    mesh.triangles = surface.triangles;
    return summarize_topology(mesh);
}

void warn_of_crowds(const TopologySummary& topology, EncodeReport& report) {
    if (const uint64_t edges = topology.nonmanifold_edges; edges > 0)
        report.warnings.push_back("glued where borders coincide, the surface has more than two triangles at " +
                                  std::to_string(edges) + (edges == 1 ? " edge" : " edges"));
}

// Codes the image and completes the report.
Result<Encoded> code(const RasterRun& run, const ReferenceSurface& reference, EncodeReport report, uint32_t threads,
                     StageClock& clock) {
    Encoded encoded;
    encoded.report = std::move(report);
    clock.begin(Stage::kCode);
    GIM_TRY(file, run.find_file());
    encoded.bytes = std::move(file);
    describe_file(encoded.bytes, encoded.report);
    clock.begin(Stage::kCompare);
    GIM_TRY(error, run.compare(encoded.bytes, run.samples(), true));
    encoded.report.error = error;
    encoded.report.folds = error.defects->folded_faces;
    GIM_TRY(levels, measure_levels(encoded.bytes, reference, error, threads));
    encoded.report.levels = levels;
    return timed(std::move(encoded), clock);
}

Result<Encoded> run_stages(const RasterImage& image, const EncodeOptions& options, const Progress& progress) {
    StageClock clock(progress);
    clock.begin(Stage::kInput);
    GIM_TRY(raster, glued(image, options));
    EncodeReport report;
    describe_image(raster, report);
    report.input_vertices = raster.surface.positions.size();
    report.input_triangles = raster.surface.triangles.size();
    report.topology = topology_of(raster.surface);
    warn_of_crowds(report.topology, report);
    const ReferenceSurface reference(std::move(raster.surface), options.threads);
    return code({raster, reference, false, options}, reference, std::move(report), options.threads, clock);
}

// How far samples may slide. A channel besides the positions belongs to the place where its sample is.
std::optional<FitOptions> fit_of(const RasterImage& image, const EncodeOptions& options) {
    EncodeOptions now = options;
    if (options.fit == FitStrength::kAuto && image.channels > 3) now.fit = FitStrength::kStiff;
    std::optional<FitOptions> fit = first_fit(now);
    if (fit) fit->thorough = true;
    return fit;
}

Result<Encoded> run_refit(const RasterImage& image, const TriangleMesh& mesh, const EncodeOptions& options,
                          const Progress& progress) {
    StageClock clock(progress);
    clock.begin(Stage::kInput);
    GIM_TRY(start, glued(image, options));
    clock.begin(Stage::kClean);
    EncodeReport report;
    GIM_TRY(surface, clean_target(mesh, options, report));
    const ReferenceSurface reference(std::move(surface), options.threads);

    RasterImage fitted = image;
    if (const auto fit = fit_of(image, options)) {
        clock.begin(Stage::kFit);
        GIM_TRY(refitted,
                fit_raster(image, start.gluing, raster_positions(image), reference.mesh(), *fit, clock.progress()));
        report.folds_before_fit = refitted.before.folds;
        fitted = std::move(refitted.image);
    }
    GIM_TRY(scale, scale_raster(fitted, options.bits));
    const std::vector<Vec3> positions = raster_positions(fitted);
    const std::vector<float> units = units_of(positions, scale);
    const Raster raster = with_surface(fitted, std::move(scale), std::move(start.gluing), positions, units);
    describe_image(raster, report);
    warn_of_crowds(topology_of(raster.surface), report);
    return code({raster, reference, true, options}, reference, std::move(report), options.threads, clock);
}

}  // namespace

Result<Encoded> encode_raster(const RasterImage& image, const EncodeOptions& options, const Progress& progress) {
    GIM_CHECK(check_options(options));
    return guarded(options.threads, [&] { return run_stages(image, options, progress); });
}

Result<Encoded> refit_raster(const RasterImage& image, const TriangleMesh& mesh, const EncodeOptions& options,
                             const Progress& progress) {
    GIM_CHECK(check_options(options));
    return guarded(options.threads, [&] { return run_refit(image, mesh, options, progress); });
}

}  // namespace gim
