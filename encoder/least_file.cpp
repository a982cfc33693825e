#include "encoder/least_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/code/decode_surface.h"
#include "encoder/code/rate_target.h"
#include "encoder/surface/refine.h"

namespace gim {

namespace {

using Bytes = std::vector<uint8_t>;
using Values = RateSearchValues;

constexpr double kCoarser = 4;  // octaves from a usual quantizer to the first one here

class LeastFile {
  public:
    LeastFile(LayoutImages& images, CodingParameters parameters, StageClock& clock)
        : images_(images), parameters_(std::move(parameters)), clock_(clock) {}

    // Goes finer until the surface has area, then coarser until it has none. Ends with a full fit at the best quantizer.
    Result<Bytes> find(double first) {
        const double start = std::clamp(std::log2(first) + kCoarser, Values::kFinest, Values::kCoarsest);
        double at = start;
        GIM_TRY(is_surface, code(at, CodedFit::Effort::kSearch));
        bool has_surface = is_surface;
        while (!has_surface && at > Values::kFinest) {
            at = std::max(at - 1, Values::kFinest);
            GIM_TRY(finer, code(at, CodedFit::Effort::kSearch));
            has_surface = finer;
        }
        while (at >= start && has_surface && at < Values::kCoarsest) {
            at = std::min(at + 1, Values::kCoarsest);
            GIM_TRY(coarser, code(at, CodedFit::Effort::kSearch));
            has_surface = coarser;
        }
        if (best_.empty()) return Error{Stage::kCode, "at every quantizer, all samples become one point"};
        if (images_.is_fitted_to_quantizer()) GIM_CHECK(code(best_at_, CodedFit::Effort::kFinal));
        return std::move(best_);
    }

  private:
    // Codes a file. Keeps it if it is the smallest with area. Returns whether it has area.
    Result<bool> code(double octave, CodedFit::Effort effort) {
        parameters_.quantizer = std::exp2(octave);
        if (images_.is_fitted_to_quantizer()) {
            images_.restart_fit();
            images_.fit(parameters_, effort, clock_);
        }
        GIM_TRY(writer, images_.writer(parameters_));
        Bytes bytes = writer.write(parameters_.quantizer);
        GIM_TRY(is_surface, has_area(bytes));
        if (is_surface && (best_.empty() || bytes.size() < best_.size())) {
            best_ = std::move(bytes);
            best_at_ = octave;
        }
        return is_surface;
    }

    LayoutImages& images_;
    CodingParameters parameters_;
    StageClock& clock_;
    Bytes best_;
    double best_at_ = 0;
};

}  // namespace

Result<bool> has_area(std::span<const uint8_t> bytes) {
    GIM_TRY(surface, decode_surface(bytes, 0));
    return surface_area(surface) > 0;
}

Result<Bytes> least_file(LayoutImages& images, CodingParameters parameters, double first, StageClock& clock) {
    return LeastFile(images, std::move(parameters), clock).find(first);
}

}  // namespace gim
