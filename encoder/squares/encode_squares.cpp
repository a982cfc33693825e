#include "encoder/squares/encode_squares.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/base/result.h"

namespace gim {

namespace {

// Images that may be fitted again and again.
struct FittedSquares {
    SquareImages squares;
    std::vector<CodedFit> fits;   // one per image, made when needed
    std::optional<Header> units;  // of the first fit: what is fitted to a quantizer must meet the same steps again

    Result<GimWriter> writer(CodingParameters parameters) const {
        parameters.units = units;
        return GimWriter::create(squares.images, parameters);
    }
};

Result<bool> make_fits(FittedSquares& state, uint64_t seed) {
    for (size_t i = state.fits.size(); i < state.squares.images.size(); ++i) {
        GIM_TRY(fit, CodedFit::create(state.squares.images[i], state.squares.surfaces[i], seed));
        state.fits.push_back(std::move(fit));
        state.squares.surfaces[i] = {};  // the fit has its own
    }
    return true;
}

// To the quantizer of the parameters.
Result<bool> fit_squares(FittedSquares& state, const CodingParameters& parameters, CodedFit::Effort effort,
                         const EncodeOptions& options, StageClock& clock) {
    clock.begin(Stage::kFit);
    GIM_TRY(made, make_fits(state, options.seed));
    (void)made;
    if (!state.units) state.units = units_of(state.squares.images, parameters.bits);
    Header header = *state.units;
    header.quantizer = quantizer_in_range(parameters.quantizer);
    for (size_t i = 0; i < state.fits.size(); ++i)
        state.squares.images[i].positions = state.fits[i].run(header, effort, clock.progress());
    clock.begin(Stage::kCode);
    return true;
}

}  // namespace

CodingJob code_squares(SquareImages squares, const EncodeOptions& options, StageClock& clock, EncodeReport& report) {
    report.layout = Layout::kGim;
    report.images = static_cast<uint32_t>(squares.images.size());
    for (const GeometryImage& image : squares.images) {
        if (image.side > report.side) report.node_side = image.sideband.node_side;
        report.side = std::max(report.side, image.side);
        report.samples += uint64_t{image.side} * image.side;
        report.cut_paths += static_cast<uint32_t>(image.sideband.paths.size());
    }
    report.width = report.height = report.side;

    const auto state = std::make_shared<FittedSquares>(FittedSquares{std::move(squares), {}, {}});
    CodingJob job;
    job.make_writer = [state](const CodingParameters& parameters) -> Result<std::unique_ptr<FileWriter>> {
        GIM_TRY(writer, state->writer(parameters));
        return std::unique_ptr<FileWriter>(new GimWriter(std::move(writer)));
    };
    job.make_planes = [state](const PlaneMaker& maker) { return maker.make(state->squares.images); };
    if (options.fit == FitStrength::kAuto && options.rate.kind != RateTarget::Kind::kLossless) {
        job.fit = [state, options, &clock](const CodingParameters& parameters, CodedFit::Effort effort) {
            return fit_squares(*state, parameters, effort, options, clock);
        };
        job.restart_fit = [state] {
            for (CodedFit& fit : state->fits) fit.restart();
        };
    }
    return job;
}

}  // namespace gim
