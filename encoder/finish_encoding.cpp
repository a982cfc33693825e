#include "encoder/finish_encoding.h"

#include <algorithm>
#include <cmath>

#include "encoder/base/result.h"
#include "encoder/code/decode_surface.h"
#include "encoder/code/level_report.h"
#include "encoder/code/rate_control.h"
#include "encoder/surface/compare_meshes.h"
#include "format/chart_table.h"
#include "gim/decoder.hpp"

namespace gim {

namespace {

constexpr uint32_t kLeastSide = 5, kMostSide = 8193, kMostPlaneSide = 4097;
constexpr uint32_t kSearchSamples = 120000;
constexpr int kMostAttempts = 3;

Result<Comparison> compare_file(std::span<const uint8_t> bytes, const ReferenceSurface& reference,
                                const CompareOptions& options) {
    GIM_TRY(decoded, decode_surface(bytes, 0));
    return reference.compare(decoded, options);
}

// From a rate target to the file that meets it.
class RateSearch {
  public:
    RateSearch(const CodingJob& job, CodingParameters parameters, const EncodeOptions& options,
               const ReferenceSurface& reference)
        : job_(job), parameters_(std::move(parameters)), target_(options.rate), reference_(reference) {
        parameters_.lossless = target_.kind == RateTarget::Kind::kLossless;
        quick_.threads = full_.threads = options.threads;
        quick_.samples = kSearchSamples;
    }

    Result<std::vector<uint8_t>> run(double quantizer) {
        if (job_.fit == nullptr || target_.kind == RateTarget::Kind::kLossless) return search(quantizer);
        if (target_.kind == RateTarget::Kind::kQuality) return fitted_file(quantizer, CodedFit::Effort::kFinal);
        GIM_TRY(nearer, approach(quantizer));
        return fit_to_target(nearer);
    }

  private:
    using Bytes = std::vector<uint8_t>;
    static constexpr int kMostApproaches = 4, kMostFits = 9;
    static constexpr double kNear = 0.25;       // octaves of the quantizer that a fit can go on over
    static constexpr double kPsnrSlack = 0.12;  // dB above the target that are good enough
    static constexpr double kBytesSlack = 0.01;

    // Goes on from the fit before, unless that was a coarser one: what it let go of may not be found again.
    Result<Bytes> fitted_file(double quantizer, CodedFit::Effort effort) {
        if (quantizer < fitted_to_ * std::exp2(-kNear)) job_.restart_fit();
        fitted_to_ = parameters_.quantizer = quantizer;
        GIM_TRY(fitted, job_.fit(parameters_, effort));
        (void)fitted;
        GIM_TRY(writer, job_.make_writer(parameters_));
        return writer->write(quantizer);
    }

    double slack_in_octaves() const {
        return target_.kind == RateTarget::Kind::kPsnr ? kPsnrSlack / kDecibelPerOctave
                                                       : kBytesSlack / std::log(kBytesPerOctave);
    }

    // How much coarser the quantizer might be, in octaves, for the target and a part of the slack to be met.
    Result<double> room(const Bytes& bytes) const {
        RateTarget wanted = target_;
        if (target_.kind == RateTarget::Kind::kBytes) {
            wanted.value *= 1 - kBytesSlack / 2;
            return octaves_to(wanted, double(bytes.size()), 0);
        }
        wanted.value += kPsnrSlack / 2;
        GIM_TRY(comparison, compare_file(bytes, reference_, quick_));
        return octaves_to(wanted, 0, comparison.psnr);
    }

    // By quick fits.
    Result<double> approach(double quantizer) {
        for (int k = 0; k < kMostApproaches; ++k) {
            GIM_TRY(bytes, fitted_file(quantizer, CodedFit::Effort::kSearch));
            GIM_TRY(octaves, room(bytes));
            quantizer = coarser_quantizer(quantizer, octaves, 4);
            if (std::abs(octaves) < kNear) break;
        }
        return quantizer;
    }

    // Every file is coded with the quantizer that it is fitted to: with one that is a tenth of an octave finer it would be
    // larger and farther from the surface. So fits go on until one meets the target, and the best of those is taken.
    Result<Bytes> fit_to_target(double quantizer) {
        Bytes best;
        double final_for = 0;  // what the last final fit was for
        for (int k = 0; k < kMostFits; ++k) {
            const bool is_far = k == 0 || std::abs(std::log2(quantizer / final_for)) > kNear;
            if (is_far) final_for = quantizer;
            GIM_TRY(bytes, fitted_file(quantizer, is_far ? CodedFit::Effort::kFinal : CodedFit::Effort::kAdjust));
            GIM_TRY(octaves, room(bytes));
            GIM_TRY(is_met, meets_target(bytes));
            if (is_met && is_better(bytes, best)) best = std::move(bytes);
            if (is_met && std::abs(octaves) <= slack_in_octaves() / 2) return best;
            const double next = coarser_quantizer(quantizer, octaves, 2);
            if (next == quantizer) break;
            quantizer = next;
        }
        if (!best.empty()) return best;
        return search(quantizer);
    }

    Result<bool> meets_target(const Bytes& bytes) const {
        if (target_.kind == RateTarget::Kind::kBytes) return double(bytes.size()) <= target_.value;
        GIM_TRY(comparison, compare_file(bytes, reference_, full_));
        return comparison.psnr >= target_.value;
    }

    bool is_better(const Bytes& bytes, const Bytes& best) const {
        if (best.empty()) return true;
        return target_.kind == RateTarget::Kind::kBytes ? bytes.size() > best.size() : bytes.size() < best.size();
    }

    // Searches with few samples, then makes sure with as many as compare() takes: a PSNR target is never missed.
    Result<std::vector<uint8_t>> search(double quantizer) const {
        CodingParameters parameters = parameters_;
        parameters.quantizer = quantizer;
        GIM_TRY(writer, job_.make_writer(parameters));
        const JudgeFile judge = [&](std::span<const uint8_t> bytes) -> Result<double> {
            GIM_TRY(comparison, compare_file(bytes, reference_, quick_));
            return comparison.psnr;
        };
        RateTarget target = target_;
        for (int attempt = 0;; ++attempt) {
            GIM_TRY(bytes, code_to_target(*writer, quantizer, target, judge));
            if (target.kind != RateTarget::Kind::kPsnr) return bytes;
            GIM_TRY(comparison, compare_file(bytes, reference_, full_));
            const double missing = target_.value - comparison.psnr;
            if (missing <= 0 || attempt == kMostAttempts) return bytes;
            target.value += missing + 0.01;
        }
    }

    const CodingJob& job_;
    CodingParameters parameters_;
    double fitted_to_ = 0;  // quantizer of the last fit
    const RateTarget target_;
    const ReferenceSurface& reference_;
    CompareOptions quick_, full_;
};

uint64_t sideband_size(std::span<const uint8_t> bytes) {
    Decoder decoder;
    if (decoder.open(bytes) != GIM_OK) return 0;
    gim_chunk chunk;
    for (uint32_t i = 0; decoder.read_chunk(i, &chunk) == GIM_OK; ++i) {
        if (std::string_view(chunk.name) == "SEAM") return chunk.size;
    }
    return 0;
}

// One value per level of the file; 0 for those that no image can close.
std::vector<double> psnr_of_levels(std::span<const LevelReport> levels, uint32_t level_count) {
    std::vector<double> psnr(level_count, 0.0);
    for (const LevelReport& level : levels) psnr[level.level] = level.psnr;
    return psnr;
}

void describe_file(std::span<const uint8_t> bytes, EncodeReport& report) {
    const double bits = 8.0 * static_cast<double>(bytes.size());
    report.file_bytes = bytes.size();
    report.sideband_bytes = sideband_size(bytes);
    report.bits_per_sample = bits / static_cast<double>(report.samples);
    report.bits_per_vertex = report.input_vertices > 0 ? bits / static_cast<double>(report.input_vertices) : 0;
}

}  // namespace

Result<bool> check_options(const EncodeOptions& options) {
    const auto is_grid = [](uint32_t side) {
        return side >= kLeastSide && side <= kMostSide && ((side - 1) & (side - 2)) == 0;
    };
    const auto wrong = [](const std::string& what) { return Error{Stage::kInput, what}; };
    if (!is_grid(options.side))
        return wrong("the size must be 2^j + 1, from 5 to 8193 (257, 513, ...); not " + std::to_string(options.side));
    if (!is_grid(options.node_side) || options.node_side > options.side) {
        return wrong("the node grid must be 2^j + 1, from 5 to the size; not " + std::to_string(options.node_side));
    }
    if (options.bits < 8 || options.bits > 20)
        return wrong("the bits must be from 8 to 20; not " + std::to_string(options.bits));
    const auto is_plane = [](uint32_t side) {
        return side == 0 || (side >= kLeastSide && side <= kMostPlaneSide && ((side - 1) & (side - 2)) == 0);
    };
    if (!is_plane(options.normal_side) || !is_plane(options.color_side.value_or(0)))
        return wrong("the sides of normal map and colours must be 2^j + 1, from 5 to 4097 (257, 513, ...), or 0");
    if (options.plane_quality && !(*options.plane_quality >= 0 && *options.plane_quality <= 100))
        return wrong("the quality of normal map and colours must be from 0 to 100");
    const double value = options.rate.value;
    switch (options.rate.kind) {
        case RateTarget::Kind::kQuality:
            if (!(value >= 0 && value <= 100)) return wrong("the quality must be from 0 to 100");
            break;
        case RateTarget::Kind::kPsnr:
            if (!(value > 0 && value <= 200)) return wrong("the PSNR must be above 0 and at most 200 dB");
            break;
        case RateTarget::Kind::kBytes:
            if (!(value >= 1)) return wrong("the number of bytes must be at least 1");
            break;
        case RateTarget::Kind::kLossless:
            break;
    }
    if (options.layout == Layout::kTiles) return wrong("the layout tiles is not there yet; take gim, mcgim or auto");
    if (options.samples < 1000 || options.samples > (1u << 26))
        return wrong("the samples must be from 1000 to 67108864; not " + std::to_string(options.samples));
    if (options.charts > kMaxCharts)
        return wrong("at most " + std::to_string(kMaxCharts) + " charts; not " + std::to_string(options.charts));
    return true;
}

Result<Encoded> finish_encoding(const CodingJob& job, Mesh reference, const TriangleMesh& input,
                                const EncodeOptions& options, StageClock& clock, Encoded encoded) {
    const ReferenceSurface surface(std::move(reference), options.threads);
    CompareOptions compare_options;
    compare_options.threads = options.threads;
    compare_options.normals = true;

    CodingParameters parameters;
    const PlaneMaker plane_maker(surface.mesh(), input, options);
    if (plane_maker.wants_any()) {
        clock.begin(Stage::kPlanes);
        GIM_TRY(planes, job.make_planes(plane_maker));
        parameters.planes = std::move(planes);
    }

    clock.begin(Stage::kCode);
    parameters.bits = options.bits;
    parameters.base_side = options.node_side;
    parameters.level_psnr = true;
    RateSearch search(job, parameters, options, surface);
    GIM_TRY(bytes, search.run(first_quantizer(options.rate, options.bits)));
    encoded.bytes = std::move(bytes);

    clock.begin(Stage::kCompare);
    GIM_TRY(comparison, compare_file(encoded.bytes, surface, compare_options));
    encoded.report.error = comparison;
    GIM_TRY(levels, measure_levels(encoded.bytes, surface, comparison, options.threads));
    encoded.report.levels = std::move(levels);
    GIM_TRY(info, read_own_info(encoded.bytes));
    encoded.bytes = set_level_psnr(encoded.bytes, psnr_of_levels(encoded.report.levels, info.level_count));
    GIM_TRY(planes, plane_maker.measure(encoded.bytes));
    encoded.report.planes = std::move(planes);
    clock.end();

    describe_file(encoded.bytes, encoded.report);
    encoded.report.times = clock.times();
    encoded.report.seconds = clock.seconds();
    return encoded;
}

}  // namespace gim
