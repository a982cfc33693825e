#include "encoder/charts/charts_layout.h"

#include <utility>
#include <vector>

#include "encoder/charts/chart_texels.h"
#include "encoder/charts/write_charts.h"

namespace gim {

namespace {

class ChartsLayout final : public LayoutImages {
  public:
    explicit ChartsLayout(ChartLevels charts) : charts_(std::move(charts)) {}

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
        return charts_writer(charts_, parameters);
    }

    std::vector<uint8_t> plane_exponents(uint32_t side) const override {
        return {chart_plane_exponent(charts_.image, side)};
    }
    TexelGrid texel_grid(size_t, uint8_t exponent) const override { return chart_texels(charts_.image, exponent); }
    Pyramid<float> analyse_plane(size_t, const TexelGrid& grid, std::vector<float> values,
                                 float quantizer) const override {
        return analyse_chart_plane(grid, std::move(values), quantizer);
    }

  private:
    ChartLevels charts_;
};

}  // namespace

std::unique_ptr<LayoutImages> charts_layout(ChartLevels charts) {
    return std::make_unique<ChartsLayout>(std::move(charts));
}

}  // namespace gim
