#include "encoder/charts/charts_layout.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/charts/chart_plane.h"
#include "encoder/charts/chart_ramps.h"
#include "encoder/charts/close_chart_seams.h"
#include "encoder/charts/write_charts.h"
#include "encoder/code/file_units.h"
#include "encoder/fit/effort.h"
#include "encoder/fit/fit_coded.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/fit/parts_codec.h"
#include "encoder/planes/rectangle_texels.h"

namespace gim {

namespace {

std::vector<CodedPart> parts_of(const ChartLevels& charts) {
    std::vector<CodedPart> parts;
    for (size_t c = 0; c < charts.charts.size(); ++c) {
        const ChartBox& box = charts.charts[c];
        parts.push_back({box.columns, box.rows, box.atlas_column, box.atlas_row, nullptr, charts.defined[c]});
    }
    return parts;
}

class ChartsLayout final : public LayoutImages {
  public:
    ChartsLayout(ChartLevels charts, const Mesh& mesh, const EncodeOptions& options)
        : charts_(std::move(charts)), is_fitted_(is_fitted_to_codec(options)) {
        if (options.rate.kind == RateTarget::Kind::kLossless) return;
        const MakeFitCodec make = [this](const FitSetting& setting) -> std::unique_ptr<FitCodec> {
            const auto ramps = std::make_shared<const ChartRamps>(charts_);
            auto codec = std::make_unique<PartsCodec>(
                setting, parts_of(charts_),
                OpenSeams{[this](std::vector<float>& image) { close_chart_seams(charts_, image); },
                          [ramps](std::vector<float>& image) { ramps->transpose(image); }});
            codec_ = codec.get();
            return codec;
        };
        fit_ = std::make_unique<CodedFit>(charts_.image, make, mesh, options.seed, Rails{}, effort_of(options).rounds);
    }

    bool is_fitted_to_quantizer() const override { return is_fitted_; }

    void fit(const CodingParameters& parameters, CodedFit::Effort effort, StageClock& clock) override {
        clock.begin(Stage::kFit);
        is_rough_ = effort == CodedFit::Effort::kSearch;
        if (!units_) units_ = chart_units(charts_, parameters.bits);
        Units units = *units_;
        units.quantizer = quantizer_in_range(parameters.quantizer);
        take_samples(fit_->run(units, effort, clock.progress()), units);
        clock.begin(Stage::kCode);
    }

    void restart_fit() override { fit_->restart(); }
    void forget_fits() override { fit_->forget(); }

    void describe(EncodeReport& report) const override {
        report.layout = Layout::kMcgim;
        report.images = 1;
        report.width = charts_.image.width();
        report.height = charts_.image.height();
        report.samples = charts_.sample_count();
        report.defined_samples = charts_.defined_count();
        report.charts = static_cast<uint32_t>(charts_.charts.size());
        report.cut_paths = static_cast<uint32_t>(charts_.mates.size());
        report.packing_efficiency = static_cast<double>(report.defined_samples) / static_cast<double>(report.samples);
    }

    Result<FileWriter> writer(const CodingParameters& parameters) const override {
        CodingParameters with_repair = parameters;
        with_repair.units = units_;
        if (fit_ && !is_rough_) {
            with_repair.repair = [this](size_t, std::span<Pyramid<int32_t>> bands, const Units& units) {
                fit_->repair(bands, units);
            };
        }
        return charts_writer(charts_, with_repair);
    }

    std::vector<uint8_t> plane_exponents(uint32_t side) const override {
        const double samples = double(charts_.image.width()) * charts_.image.height();
        return {texel_exponent(side / std::sqrt(samples))};
    }
    TexelGrid texel_grid(size_t, uint8_t exponent) const override { return rectangle_texels(charts_.image, exponent); }
    PlaneCoder analyse_plane(size_t, const TexelGrid& grid, std::vector<float> values, float quantizer) const override {
        return coder_of(analyse_chart_plane(grid, std::move(values), quantizer));
    }

  private:
    // Puts samples into the rectangle and into the boxes, which are extended.
    void take_samples(std::vector<Vec3> positions, const Units& units) {
        charts_.image.positions = std::move(positions);
        const std::vector<float> image = to_units<float>(charts_.image.positions, units);
        const auto& boxes = codec_->extend(image, units.quantizer);
        for (size_t c = 0; c < boxes.size(); ++c) {
            for (size_t i = 0; i < charts_.positions[c].size(); ++i) {
                for (size_t k = 0; k < 3; ++k)
                    charts_.positions[c][i][static_cast<int>(k)] =
                        double{units.origin[k]} + double{units.step} * double{boxes[c][3 * i + k]};
            }
        }
        charts_.is_extended = true;
    }

    ChartLevels charts_;
    bool is_fitted_;
    bool is_rough_ = false;          // after a quick fit
    std::unique_ptr<CodedFit> fit_;  // of a lossy file
    PartsCodec* codec_ = nullptr;    // of the fit
    std::optional<Units> units_;     // of the first fit
};

}  // namespace

std::unique_ptr<LayoutImages> charts_layout(ChartLevels charts, const Mesh& mesh, const EncodeOptions& options) {
    return std::make_unique<ChartsLayout>(std::move(charts), mesh, options);
}

}  // namespace gim
