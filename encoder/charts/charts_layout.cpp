#include "encoder/charts/charts_layout.h"

#include <cmath>
#include <utility>
#include <vector>

#include "encoder/charts/chart_plane.h"
#include "encoder/charts/close_chart_seams.h"
#include "encoder/charts/write_charts.h"
#include "encoder/fit/fold_repair.h"
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
    ChartsLayout(ChartLevels charts, const Mesh& mesh, const EncodeOptions& options) : charts_(std::move(charts)) {
        if (options.rate.kind == RateTarget::Kind::kLossless) return;
        repair_ =
            std::make_unique<FoldRepair>(charts_.image, mesh, parts_of(charts_),
                                         [this](std::vector<float>& image) { close_chart_seams(charts_, image); });
    }

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
        if (repair_) {
            with_repair.repair = [this](size_t, std::span<Pyramid<int32_t>> bands, const Units& units) {
                repair_->repair(bands, units, kLastRepair);
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
    ChartLevels charts_;
    std::unique_ptr<FoldRepair> repair_;  // of a lossy file
};

}  // namespace

std::unique_ptr<LayoutImages> charts_layout(ChartLevels charts, const Mesh& mesh, const EncodeOptions& options) {
    return std::make_unique<ChartsLayout>(std::move(charts), mesh, options);
}

}  // namespace gim
