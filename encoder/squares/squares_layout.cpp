#include "encoder/squares/squares_layout.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/base/at_once.h"
#include "encoder/code/file_units.h"
#include "encoder/fit/effort.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/squares/square_fit.h"
#include "encoder/squares/square_texels.h"
#include "encoder/squares/write_squares.h"
#include "format/sideband_code.h"

namespace gim {

namespace {

class SquaresLayout final : public LayoutImages {
  public:
    SquaresLayout(Squares squares, const EncodeOptions& options)
        : squares_(std::move(squares)), is_lossy_fit_(is_fitted_to_codec(options)) {
        if (options.rate.kind != RateTarget::Kind::kLossless) make_fits(options);
    }

    void describe(EncodeReport& report) const override {
        report.layout = Layout::kGim;
        report.images = static_cast<uint32_t>(squares_.images.size());
        for (const SquareImage& image : squares_.images) {
            if (image.side() > report.side) report.node_side = image.sideband.node_side;
            report.side = std::max(report.side, image.side());
            report.samples += image.positions.size();
            report.cut_paths += static_cast<uint32_t>(image.sideband.paths.size());
        }
        report.width = report.height = report.side;
        report.folds_before_fit += folds_before_fit_;
    }

    bool is_fitted_to_quantizer() const override { return is_lossy_fit_; }

    void fit(const CodingParameters& parameters, CodedFit::Effort effort, StageClock& clock) override {
        clock.begin(Stage::kFit);
        is_rough_ = effort == CodedFit::Effort::kSearch;
        if (!units_) units_ = units_of(squares_.images, parameters.bits);
        Units units = *units_;
        units.quantizer = quantizer_in_range(parameters.quantizer);
        const auto run = [&](size_t i, const Progress& progress) {
            squares_.images[i].positions = fits_[i].run(units, effort, progress);
        };
        if (fits_.size() == 1)
            run(0, clock.progress());
        else
            for_each_at_once(fits_.size(), clock, [&](size_t i) { run(i, {}); });
        clock.begin(Stage::kCode);
    }

    void restart_fit() override {
        for (SquareFit& fit : fits_) fit.restart();
    }

    void forget_fits() override {
        for (SquareFit& fit : fits_) fit.forget();
    }

    Result<FileWriter> writer(const CodingParameters& parameters) const override {
        CodingParameters with_units = parameters;
        with_units.units = units_;
        if (!is_rough_ && !fits_.empty()) {
            with_units.repair = [this](size_t first, std::span<Pyramid<int32_t>> bands, const Units& units) {
                for (size_t i = 0; i < bands.size(); ++i) fits_[first + i].repair(bands.subspan(i, 1), units);
            };
        }
        return squares_writer(squares_.images, with_units);
    }

    std::vector<uint8_t> plane_exponents(uint32_t side) const override {
        return square_plane_exponents(squares_.images, side);
    }
    TexelGrid texel_grid(size_t image, uint8_t exponent) const override {
        return square_texels(squares_.images[image], (1u << exponent) + 1);
    }
    PlaneCoder analyse_plane(size_t image, const TexelGrid& grid, std::vector<float> values, float) const override {
        equalize_ring(squares_.images[image].sideband, grid.columns, values);
        return coder_of(analyse<Irreversible97>(std::move(values), grid.columns));
    }

  private:
    void make_fits(const EncodeOptions& options) {
        for (size_t i = 0; i < squares_.surfaces.size(); ++i) {
            const SquareImage& image = squares_.images[i];
            fits_.emplace_back(image, squares_.surfaces[i], options.seed, effort_of(options).rounds);
            if (!needs_first_fit(options, image.side())) folds_before_fit_ += fits_.back().folds();
            squares_.surfaces[i] = {};  // the fit has its own copy
        }
    }

    Squares squares_;
    bool is_lossy_fit_;
    uint64_t folds_before_fit_ = 0;        // of images that no other fit precedes
    bool is_rough_ = false;                // after a quick fit
    mutable std::vector<SquareFit> fits_;  // one per image of a lossy file; mutable: repairing keeps search trees warm
    std::optional<Units> units_;  // of the first fit; samples fitted to a quantizer must be coded with the same steps
};

}  // namespace

std::unique_ptr<LayoutImages> squares_layout(Squares squares, const EncodeOptions& options) {
    return std::make_unique<SquaresLayout>(std::move(squares), options);
}

}  // namespace gim
