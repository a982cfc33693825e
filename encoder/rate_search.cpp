#include "encoder/rate_search.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "encoder/code/decode_surface.h"
#include "encoder/code/next_quantizer.h"
#include "encoder/code/quantizer_bracket.h"
#include "encoder/code/rate_target.h"
#include "encoder/least_file.h"
#include "encoder/search_files.h"

namespace gim {

namespace {

using Bytes = RateSearch::Bytes;
using Values = RateSearchValues;

// Codes a file at a quantizer.
using CodeFile = std::function<Result<Bytes>(double quantizer)>;

std::string four_digits(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

// Returns the value with three digits. Rounds up, so that a user may ask for what is written.
double rounded_up(double value) {
    if (!(value > 0)) return value;
    const double digit = std::pow(10, std::floor(std::log10(value)) - 2);
    return std::ceil(value / digit) * digit;
}

}  // namespace

struct RateSearch::Impl {
    Impl(LayoutImages& images, CodingParameters parameters, const EncodeOptions& options,
         const ReferenceSurface& reference, StageClock& clock)
        : images_(images),
          parameters_(std::move(parameters)),
          first_quantizer_(first_quantizer(options.rate, options.bits)),
          target_(options.rate),
          reference_(reference),
          clock_(clock) {
        parameters_.lossless = target_.kind == RateTarget::Kind::kLossless;
        quick_.threads = full_.threads = options.threads;
        quick_.samples = Values::kSearchSamples;
        quick_.vertices = full_.vertices = target_.kind == RateTarget::Kind::kMaxError;
    }

    Result<Estimate> estimate(std::optional<double> near) {
        const double quantizer = near.value_or(first_quantizer_);
        if (images_.is_fitted_to_quantizer()) {
            GIM_TRY(approached, is_searched(target_) ? approach(quantizer, near.has_value()) : fit_briefly(quantizer));
            approached_ = std::move(approached);
        } else {
            parameters_.quantizer = quantizer;
            GIM_TRY(writer, images_.writer(parameters_));
            approached_ = Approached{writer.write(quantizer), quantizer, {}};
        }
        if (!approached_->psnr) {
            GIM_TRY(comparison, compare_file(approached_->bytes, reference_, quick_));
            approached_->psnr = comparison.psnr;
        }
        const double psnr = *approached_->psnr;
        return Estimate{log_bytes(double(approached_->bytes.size()), psnr), approached_->quantizer, psnr};
    }

    Result<Bytes> run(const Contest& contest) {
        contest_ = contest;
        if (target_.kind == RateTarget::Kind::kMaxError) return code_within_error(first_quantizer_);
        return target_.kind == RateTarget::Kind::kBytes ? code_within_budget() : approach_and_code();
    }

  private:
    struct Approached {
        Bytes bytes;                 // the last file
        double quantizer = 0;        // the next one to try
        std::optional<double> psnr;  // of that file; nothing if it was not compared
    };
    struct Room {
        double octaves;
        std::optional<double> psnr;
    };

    Result<Bytes> approach_and_code() {
        if (!images_.is_fitted_to_quantizer()) return search(first_quantizer_);
        if (target_.kind == RateTarget::Kind::kQuality) {
            if (approached_) images_.forget_fits();  // the file is the one without an estimate
            return fitted_file(first_quantizer_, CodedFit::Effort::kFinal);
        }
        if (approached_ && contest_.is_target_rough)
            return fitted_file(approached_->quantizer, CodedFit::Effort::kFinal);
        if (approached_) return fit_to_target(approached_->quantizer);
        GIM_TRY(approached, approach(first_quantizer_, false));
        return fit_to_target(approached.quantizer);
    }

    // No file is smaller than one without details. So a budget below that needs no search.
    Result<bool> is_below_all_files() const {
        GIM_TRY(writer, images_.writer(parameters_));
        return target_.value < double(writer.write(std::exp2(Values::kCoarsest)).size());
    }

    Result<Bytes> code_within_budget() {
        if (target_.value == kFewestBytes) return least_file(images_, parameters_, first_quantizer_, clock_);
        const Error too_few{Stage::kCode, "no file found is small enough"};
        GIM_TRY(is_hopeless, is_below_all_files());
        if (is_hopeless) return too_few;
        GIM_TRY(found, approach_and_code());
        if (found.empty()) return too_few;
        return found;
    }

    // Continues the last fit. Restarts if that one was coarser, because dropped details may not come back.
    Result<Bytes> fitted_file(double quantizer, CodedFit::Effort effort) {
        if (quantizer < fitted_to_ * std::exp2(-Values::kNear)) images_.restart_fit();
        fitted_to_ = parameters_.quantizer = quantizer;
        images_.fit(parameters_, effort, clock_);
        GIM_TRY(writer, images_.writer(parameters_));
        return writer.write(quantizer);
    }

    // Fits in full. Adjusts the last full fit instead if its quantizer is near.
    Result<Bytes> finally_fitted_file(double quantizer) {
        const bool is_far =
            finally_fitted_to_ == 0 || std::abs(std::log2(quantizer / finally_fitted_to_)) > Values::kNear;
        if (is_far) finally_fitted_to_ = quantizer;
        return fitted_file(quantizer, is_far ? CodedFit::Effort::kFinal : CodedFit::Effort::kAdjust);
    }

    double slack_in_octaves() const {
        return target_.kind == RateTarget::Kind::kPsnr ? Values::kFittedPsnrSlack / Values::kDecibelPerOctave
                                                       : Values::kFittedBytesSlack / std::log(Values::kBytesPerOctave);
    }

    // Estimates by how many octaves the quantizer could be coarser and still meet the target plus half its slack.
    Result<Room> room(const Bytes& bytes) const {
        RateTarget wanted = target_;
        if (target_.kind == RateTarget::Kind::kBytes) {
            wanted.value *= 1 - Values::kFittedBytesSlack / 2;
            return Room{octaves_to(wanted, double(bytes.size()), 0), {}};
        }
        if (target_.kind == RateTarget::Kind::kPsnr) wanted.value += Values::kFittedPsnrSlack / 2;
        GIM_TRY(comparison, compare_file(bytes, reference_, quick_));
        return Room{octaves_to(wanted, 0, comparison.psnr), comparison.psnr};
    }

    // Estimates whether a search that goes on from this file would lose against another side. over: by how much of its
    // bytes the file may seem too large.
    bool is_losing(const Bytes& bytes, double room, std::optional<double> slope, double over) const {
        if (target_.kind != RateTarget::Kind::kPsnr) return false;
        const bool are_samples_few = slope && *slope < Values::kHopelessSlope && room < -Values::kHopelessRoom;
        if (contest_.is_finer_to_come && are_samples_few) return true;
        const double at_target = double(bytes.size()) * std::pow(Values::kBytesPerOctave, -room);
        return contest_.rival_bytes > 0 && at_target > (1 + over) * contest_.rival_bytes;
    }

    Result<Approached> fit_briefly(double quantizer) {
        GIM_TRY(bytes, fitted_file(quantizer, CodedFit::Effort::kSearch));
        return Approached{std::move(bytes), quantizer, {}};
    }

    // Approaches the target's quantizer by quick fits. afresh: each begins anew. Where several images are compared, one whose
    // last fit continues another seems to take some 6 % fewer bytes than one whose fit does not.
    Result<Approached> approach(double quantizer, bool afresh) {
        NextQuantizer next(Values::kMostStep);
        Approached approached{{}, quantizer, {}};
        for (int k = 0; k < Values::kMostApproaches; ++k) {
            if (afresh) images_.restart_fit();
            GIM_TRY(bytes, fitted_file(approached.quantizer, CodedFit::Effort::kSearch));
            GIM_TRY(left, room(bytes));
            if (is_losing(bytes, left.octaves, next.slope(), Values::kQuickExcess)) return lost();
            approached = {std::move(bytes), next.after(approached.quantizer, left.octaves), left.psnr};
            if (std::abs(left.octaves) < Values::kNear) break;
        }
        return approached;
    }

    // Fits until a file meets the target closely, and returns the best file that meets it. Each file is coded with the
    // quantizer that it is fitted to. A tenth of an octave finer would make it larger and farther from the surface.
    Result<Bytes> fit_to_target(double quantizer) {
        Bytes best;
        NextQuantizer next(Values::kMostFinalStep);
        for (int k = 0; k < Values::kMostFits; ++k) {
            GIM_TRY(bytes, finally_fitted_file(quantizer));
            GIM_TRY(left, room(bytes));
            const double octaves = left.octaves;
            GIM_TRY(is_met, meets_target(bytes, left.psnr));
            const double tried = quantizer;
            quantizer = next.after(tried, octaves);
            const bool is_losing_now = is_losing(bytes, octaves, next.slope(), Values::kFinalExcess);
            if (is_met && is_better(bytes, best)) best = std::move(bytes);
            // By how much the file is better than asked: finer than a PSNR needs, or smaller than a budget allows.
            const double beyond = target_.kind == RateTarget::Kind::kBytes ? -octaves : octaves;
            if (is_met && beyond <= slack_in_octaves() / 2) return best;
            if (best.empty() && is_losing_now) return lost();
            if (quantizer == tried) break;
        }
        if (!best.empty()) return best;
        return search(quantizer);
    }

    static Error lost() { return {Stage::kCode, "another image takes fewer bytes"}; }

    // psnr: of few samples. Where that is far below the target, no more samples are taken.
    Result<bool> meets_target(const Bytes& bytes, std::optional<double> psnr) const {
        if (target_.kind == RateTarget::Kind::kBytes)
            return double(bytes.size()) <= target_.value ? has_area(bytes) : Result<bool>(false);
        if (psnr && *psnr < target_.value - Values::kPsnrOfFewSamples) return false;
        GIM_TRY(comparison, compare_file(bytes, reference_, full_));
        return comparison.psnr >= target_.value;
    }

    bool is_better(const Bytes& bytes, const Bytes& best) const {
        if (best.empty()) return true;
        return target_.kind == RateTarget::Kind::kBytes ? bytes.size() > best.size() : bytes.size() < best.size();
    }

    // Searches with few samples, then checks a PSNR target with as many as compare() takes. Repeats while it is missed.
    Result<Bytes> search(double quantizer) const {
        CodingParameters parameters = parameters_;
        parameters.quantizer = quantizer;
        GIM_TRY(writer, images_.writer(parameters));
        const JudgeFile judge = [&](std::span<const uint8_t> bytes) -> Result<double> {
            GIM_TRY(comparison, compare_file(bytes, reference_, quick_));
            return comparison.psnr;
        };
        RateTarget target = target_;
        for (int attempt = 0;; ++attempt) {
            GIM_TRY(bytes, code_to_target(writer, quantizer, target, judge));
            if (target.kind != RateTarget::Kind::kPsnr) return bytes;
            GIM_TRY(comparison, compare_file(bytes, reference_, full_));
            const double missing = target_.value - comparison.psnr;
            if (missing <= 0 || attempt == Values::kMostAttempts) return bytes;
            target.value += missing + Values::kPsnrBeyond;
        }
    }

    // Fits the samples to ever finer quantizers, if they can be fitted. Where that fails, keeps them: at the finest
    // quantizer they show what is in reach.
    Result<Bytes> code_within_error(double quantizer) {
        const bool is_fitted = images_.is_fitted_to_quantizer();
        if (is_fitted) {
            QuantizerBracket fits(Values::kDecibelPerOctave);
            const CodeFile fit = [&](double at) { return finally_fitted_file(at); };
            GIM_TRY(best, smallest_within_error(fits, quantizer, fit, Values::kMostErrorFits));
            if (!best.empty()) return best;
        }
        GIM_TRY(writer, images_.writer(parameters_));
        const CodeFile keep = [&](double at) -> Result<Bytes> { return writer.write(at); };
        QuantizerBracket files(Values::kPlainDecibelPerOctave);
        if (!is_fitted) {
            GIM_TRY(best, smallest_within_error(files, quantizer, keep, Values::kMostErrorFiles));
            if (!best.empty()) return best;
        }
        GIM_TRY(best, smallest_within_error(files, std::exp2(Values::kFinest), keep, Values::kMostErrorFiles));
        if (!best.empty()) return best;
        return error_out_of_reach();
    }

    // Codes files at the quantizers that the bracket asks for. Returns the smallest one that meets the target, or nothing.
    Result<Bytes> smallest_within_error(QuantizerBracket& bracket, double first, const CodeFile& code, int most) {
        Bytes best;
        std::optional<double> quantizer = first;
        for (int k = 0; k < most && quantizer; ++k) {
            GIM_TRY(bytes, code(*quantizer));
            GIM_TRY(margin, error_margin(bytes));
            bracket.add(*quantizer, margin);
            quantizer = bracket.next();
            if (margin >= 0 && is_better(bytes, best)) best = std::move(bytes);
        }
        return best;
    }

    // Returns by how many dB the largest distance is below the target's. Sampled distances are never too large, so few
    // samples may reject a file. Only as many as compare() takes may accept it.
    Result<double> error_margin(const Bytes& bytes) {
        const double allowed = target_.value * reference_.diagonal();
        const auto sampled = compare_file(bytes, reference_, quick_);
        const bool has_area = sampled.ok() || sampled.error().stage != Stage::kCompare;
        if (!has_area) return -Values::kMostMargin;  // the quantizer is so coarse that all samples are one
        if (!sampled.ok()) return sampled.error();
        double distance = sampled.value().hausdorff;
        if (distance <= allowed) {
            GIM_TRY(comparison, compare_file(bytes, reference_, full_));
            distance = comparison.hausdorff;
        }
        if (nearest_.empty() || distance < least_distance_) {
            nearest_ = bytes;
            least_distance_ = distance;
        }
        return 20 * std::log10(allowed / distance);
    }

    Result<Bytes> error_out_of_reach() const {
        GIM_TRY(comparison, compare_file(nearest_, reference_, full_));
        const double share = 100 / reference_.diagonal();
        const double wanted = target_.value * reference_.diagonal(), reached = rounded_up(comparison.hausdorff);
        return Error{Stage::kCode, "a largest error of " + four_digits(wanted) + " (" + four_digits(share * wanted) +
                                       " % of the diagonal) is out of reach: the samples themselves reach " +
                                       four_digits(reached) + " (" + four_digits(rounded_up(share * reached)) +
                                       " %); take a larger --size (charts: --samples), or allow more"};
    }

    LayoutImages& images_;
    CodingParameters parameters_;
    const double first_quantizer_;
    std::optional<Approached> approached_;  // of estimate()
    double fitted_to_ = 0;                  // quantizer of the last fit
    double finally_fitted_to_ = 0;          // of the last full one
    Bytes nearest_;                         // the file of the least largest distance so far
    double least_distance_ = 0;
    const RateTarget target_;
    Contest contest_;
    const ReferenceSurface& reference_;
    StageClock& clock_;
    CompareOptions quick_, full_;
};

RateSearch::RateSearch(LayoutImages& images, CodingParameters parameters, const EncodeOptions& options,
                       const ReferenceSurface& reference, StageClock& clock)
    : impl_(std::make_unique<Impl>(images, std::move(parameters), options, reference, clock)) {}
RateSearch::~RateSearch() = default;

Result<Estimate> RateSearch::estimate(std::optional<double> near) { return impl_->estimate(near); }
Result<RateSearch::Bytes> RateSearch::run(const Contest& contest) { return impl_->run(contest); }

}  // namespace gim
