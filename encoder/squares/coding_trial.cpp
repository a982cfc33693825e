#include "encoder/squares/coding_trial.h"

#include <cmath>

#include "encoder/code/decode_surface.h"
#include "encoder/code/rate_control.h"
#include "encoder/fit/fit_coded.h"
#include "encoder/squares/write_squares.h"

namespace gim {

namespace {

constexpr uint32_t kSamples = 60000;
constexpr int kMostGuesses = 3;
constexpr double kNearEnough = 0.5;  // octaves of the quantizer

}  // namespace

CodingTrial::CodingTrial(const Mesh& surface, const EncodeOptions& options, const GeometryImage& example)
    : surface_(surface, options.threads), options_(options), quantizer_(quantizer_for(example)) {}

Result<CodingTrial::Coded> CodingTrial::coded(const GeometryImage& image, double quantizer) const {
    CodingParameters parameters;
    parameters.lossless = false;
    parameters.bits = options_.bits;
    parameters.base_side = options_.node_side;
    parameters.quantizer = quantizer;
    parameters.units = units_of({&image, 1}, options_.bits);
    Header header = *parameters.units;
    header.quantizer = quantizer_in_range(quantizer);
    GIM_TRY(fit, CodedFit::create(image, surface_.mesh(), options_.seed));
    GeometryImage fitted = image;
    fitted.positions = fit.run(header, CodedFit::Effort::kSearch);
    GIM_TRY(bytes, write_gim({&fitted, 1}, parameters));
    GIM_TRY(decoded, decode_surface(bytes, 0));
    CompareOptions quick;
    quick.threads = options_.threads;
    quick.samples = kSamples;
    GIM_TRY(comparison, surface_.compare(decoded, quick));
    return Coded{double(bytes.size()), comparison.psnr};
}

double CodingTrial::quantizer_for(const GeometryImage& image) const {
    double quantizer = first_quantizer(options_.rate, options_.bits);
    for (int k = 0; k < kMostGuesses; ++k) {
        const auto now = coded(image, quantizer);
        if (!now.ok()) break;
        const double octaves = octaves_to(options_.rate, now.value().bytes, now.value().psnr);
        quantizer = coarser_quantizer(quantizer, octaves, 4);
        if (std::abs(octaves) < kNearEnough) break;
    }
    return quantizer;
}

Result<double> CodingTrial::log_bytes(const GeometryImage& image) const {
    GIM_TRY(now, coded(image, quantizer_));
    return std::log(now.bytes) - now.psnr * std::log(kBytesPerOctave) / kDecibelPerOctave;
}

}  // namespace gim
