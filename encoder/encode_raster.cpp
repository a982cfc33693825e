// The driver from an image of another program to a .gim file.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "encoder/base/guarded.h"
#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/check_options.h"
#include "encoder/code/decode_surface.h"
#include "encoder/code/level_report.h"
#include "encoder/code/rate_target.h"
#include "encoder/file_run.h"
#include "encoder/raster/glue_raster.h"
#include "encoder/raster/quantize_raster.h"
#include "encoder/raster/raster_surface.h"
#include "encoder/raster/write_raster.h"
#include "encoder/surface/compare_meshes.h"

namespace gim {
namespace {

constexpr int kStepsPerOctave = 8;
constexpr double kFloatTolerance = 1e-6;  // diagonals
// Samples of a comparison: thousands of small images must not take as long as large ones.
constexpr size_t kSamplesPerTriangle = 16, kFewestSamples = 20000;

using File = std::vector<uint8_t>;

class RasterRun {
  public:
    RasterRun(const RasterImage& image, const RasterScale& scale, const EncodeOptions& options)
        : image_(image),
          scale_(scale),
          options_(options),
          positions_(raster_positions(image)),
          units_(units()),
          gluing_(glued()),
          reference_(reference_of(surface(), options.threads)) {}

    // Call nothing else but gluing() if not.
    bool has_triangles() const { return reference_.has_value(); }
    const ReferenceSurface& reference() const { return *reference_; }
    const RasterGluing& gluing() const { return gluing_; }

    // Never larger than the lossless file: on very smooth images rounding may cost more than it saves.
    Result<File> find_file() const {
        File exact = write_raster(image_, scale_, gluing_, 0);
        if (options_.rate.kind == RateTarget::Kind::kLossless) return exact;
        GIM_TRY(file, find_lossy_file(exact));
        return exact.size() <= file.size() ? std::move(exact) : std::move(file);
    }
    // Samples of the comparisons that decide and that are reported.
    uint32_t samples() const {
        const size_t wanted = kSamplesPerTriangle * reference_->mesh().triangles.size();
        return static_cast<uint32_t>(std::clamp<size_t>(wanted, kFewestSamples, CompareOptions{}.samples));
    }
    Result<Comparison> compare(const File& file, uint32_t samples, bool defects) const {
        CompareOptions options;
        options.samples = samples;
        options.threads = options_.threads;
        options.defects = defects;
        return compare_file(file, *reference_, options);
    }

  private:
    Result<File> find_lossy_file(const File& exact) const {
        const RateTarget rate = resolved_target(options_.rate, reference_->diagonal());
        if (rate.kind == RateTarget::Kind::kQuality)
            return write_raster(image_, scale_, gluing_, std::max(first_quantizer(rate, scale_.units.bits), 1.0));
        if (rate.kind == RateTarget::Kind::kBytes)
            return double(exact.size()) <= rate.value ? exact : within_bytes(rate.value);
        return within_error(rate, exact);
    }
    double tolerance() const {
        if (!options_.weld_tolerance && is_whole(image_.type)) return 0;
        const Length length = options_.weld_tolerance.value_or(Length{kFloatTolerance, true});
        if (!length.in_diagonals) return length.value;
        Vec3 low = Vec3::Constant(INFINITY), high = -low;
        for (size_t i = 0; i < positions_.size(); ++i) {
            if (!image_.defined[i]) continue;
            low = low.cwiseMin(positions_[i]);
            high = high.cwiseMax(positions_[i]);
        }
        return length.value * (high - low).norm();
    }
    static std::optional<ReferenceSurface> reference_of(Mesh surface, uint32_t threads) {
        if (surface.triangles.empty()) return {};
        return std::optional<ReferenceSurface>(std::in_place, std::move(surface), threads);
    }
    // Positions in units, from the box's lower corner on.
    std::vector<float> units() const {
        std::vector<float> units;
        for (const Vec3& p : positions_) {
            for (int k = 0; k < 3; ++k)
                units.push_back(
                    static_cast<float>((p[k] - scale_.low[static_cast<size_t>(k)]) / double{scale_.units.step}));
        }
        return units;
    }
    RasterGluing glued() const {
        RasterGluing gluing = glue_raster(image_, positions_, tolerance());
        open_crowded_edges(image_.width, image_.height, units_, gluing);
        return gluing;
    }
    Mesh surface() const {
        return raster_surface(gluing_, raster_triangles(gluing_, image_.width, image_.height, units_), positions_);
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
                                                        : c.hausdorff > rate.value * reference_->diagonal();
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
        return Error{Stage::kCode, "out of reach with " + std::to_string(scale_.units.bits) +
                                       " bits per coordinate; take more --bits"};
    }

    const RasterImage& image_;
    const RasterScale& scale_;
    const EncodeOptions& options_;
    std::vector<Vec3> positions_;
    std::vector<float> units_;
    RasterGluing gluing_;
    std::optional<ReferenceSurface> reference_;  // none without a triangle
};

void describe_surface(const RasterImage& image, const RasterRun& run, EncodeReport& report) {
    const RasterGluing& gluing = run.gluing();
    const Mesh& surface = run.reference().mesh();
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
    report.input_vertices = surface.positions.size();
    report.input_triangles = surface.triangles.size();
    TriangleMesh mesh;
    for (const Vec3& p : surface.positions) mesh.positions.push_back({p.x(), p.y(), p.z()});
    mesh.triangles = surface.triangles;
    report.topology = summarize_topology(mesh);
    if (const uint64_t edges = report.topology.nonmanifold_edges; edges > 0)
        report.warnings.push_back("glued where borders coincide, the surface has more than two triangles at " +
                                  std::to_string(edges) + (edges == 1 ? " edge" : " edges"));
}

Result<Encoded> run_stages(const RasterImage& image, const EncodeOptions& options, const Progress& progress) {
    StageClock clock(progress);
    clock.begin(Stage::kInput);
    GIM_TRY(scale, scale_raster(image, options.bits));
    const RasterRun run(image, scale, options);
    if (!run.has_triangles())
        return Error{Stage::kInput, "the mask leaves no surface: no cell of four samples has three that are defined"};
    Encoded encoded;
    EncodeReport& report = encoded.report;
    describe_surface(image, run, report);
    clock.begin(Stage::kCode);
    GIM_TRY(file, run.find_file());
    encoded.bytes = std::move(file);
    describe_file(encoded.bytes, report);
    clock.begin(Stage::kCompare);
    GIM_TRY(error, run.compare(encoded.bytes, run.samples(), true));
    report.error = error;
    report.folds = error.defects->folded_faces;
    GIM_TRY(levels, measure_levels(encoded.bytes, run.reference(), error, options.threads));
    report.levels = levels;
    return timed(std::move(encoded), clock);
}

}  // namespace

Result<Encoded> encode_raster(const RasterImage& image, const EncodeOptions& options, const Progress& progress) {
    GIM_CHECK(check_options(options));
    return guarded(options.threads, [&] { return run_stages(image, options, progress); });
}

}  // namespace gim
