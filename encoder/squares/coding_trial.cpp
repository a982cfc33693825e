#include "encoder/squares/coding_trial.h"

#include <cmath>
#include <memory>

#include "encoder/code/decode_surface.h"
#include "encoder/code/file_units.h"
#include "encoder/code/rate_target.h"
#include "encoder/fit/effort.h"
#include "encoder/squares/square_codec.h"
#include "encoder/squares/write_squares.h"

namespace gim {

using Values = RateSearchValues;

CodingTrial::CodingTrial(const Mesh& surface, const EncodeOptions& options, const SquareImage& example)
    : surface_(surface, options.threads),
      fit_surface_(std::make_shared<const FitSurface>(surface)),
      options_(options),
      quantizer_(quantizer_for(example)) {}

Result<CodingTrial::Coded> CodingTrial::coded(const SquareImage& image, double quantizer) const {
    CodingParameters parameters;
    parameters.lossless = false;
    parameters.bits = options_.bits;
    parameters.base_side = options_.node_side;
    parameters.quantizer = quantizer;
    parameters.units = units_of({&image, 1}, options_.bits);
    Units units = *parameters.units;
    units.quantizer = quantizer_in_range(quantizer);
    CodedFit fit(image, square_codec(image.side(), file_seams(image)), fit_surface_, options_.seed, Rails{},
                 effort_of(options_).rounds);
    SquareImage fitted = image;
    fitted.positions = fit.run(units, CodedFit::Effort::kSearch);
    GIM_TRY(bytes, write_squares({&fitted, 1}, parameters));
    CompareOptions quick;
    quick.threads = options_.threads;
    quick.samples = Values::kTrialSamples;
    quick.vertices = false;
    GIM_TRY(comparison, compare_file(bytes, surface_, quick));
    return Coded{double(bytes.size()), comparison.psnr};
}

double CodingTrial::quantizer_for(const SquareImage& image) const {
    double quantizer = first_quantizer(options_.rate, options_.bits);
    for (int k = 0; k < Values::kMostGuesses; ++k) {
        const auto now = coded(image, quantizer);
        if (!now.ok()) break;
        const double octaves = octaves_to(options_.rate, now.value().bytes, now.value().psnr);
        quantizer = coarser_quantizer(quantizer, octaves, Values::kMostStep);
        if (std::abs(octaves) < Values::kNearEnough) break;
    }
    return quantizer;
}

Result<double> CodingTrial::log_bytes(const SquareImage& image) const {
    GIM_TRY(now, coded(image, quantizer_));
    return gim::log_bytes(now.bytes, now.psnr);
}

}  // namespace gim
