#include "encoder/tiles/tiles_layout.h"

#include <optional>
#include <utility>
#include <vector>

#include "encoder/code/file_units.h"
#include "encoder/fit/effort.h"
#include "encoder/fit/fit_coded.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/tiles/sample_tiles.h"
#include "encoder/tiles/tile_codec.h"
#include "encoder/tiles/tile_plane.h"
#include "encoder/tiles/write_tiles.h"

namespace gim {

namespace {

class TilesLayout final : public LayoutImages {
  public:
    TilesLayout(MadeTiles made, std::vector<uint32_t> sample_at)
        : made_(std::move(made)), sample_at_(std::move(sample_at)) {
        take_samples();
    }

    Result<void> make_fit(const Mesh& mesh, const EncodeOptions& options) {
        Result<void> made;
        const MakeFitCodec make = [&](const FitSetting& setting) -> std::unique_ptr<FitCodec> {
            auto codec = TileCodec::make(made_.tiles, setting);
            if (codec.ok()) {
                codec_ = codec.value().get();
                return std::move(codec.value());
            }
            made = codec.error();
            return nullptr;
        };
        fit_.emplace(made_.atlas, make, mesh, options.seed, made_.rails, effort_of(options).rounds);
        return made;
    }

    void describe(EncodeReport& report) const override {
        report.layout = Layout::kTiles;
        report.images = 1;
        report.width = made_.atlas.width();
        report.height = made_.atlas.height();
        report.samples = made_.tiles.positions.size();
        report.tiles = static_cast<uint32_t>(made_.tiles.quads.size());
        report.side = (1u << made_.tiles.exponent) + 1;
    }

    bool is_fitted_to_quantizer() const override { return fit_.has_value(); }

    void fit(const CodingParameters& parameters, CodedFit::Effort effort, StageClock& clock) override {
        clock.begin(Stage::kFit);
        is_rough_ = effort == CodedFit::Effort::kSearch;
        if (!units_) {
            const auto units = tile_units(made_.tiles, parameters.bits);
            units_ = units.value();  // the complex was checked when the fit was made
        }
        Units units = *units_;
        units.quantizer = quantizer_in_range(parameters.quantizer);
        made_.atlas.positions = fit_->run(units, effort, clock.progress());
        take_samples();
        clock.begin(Stage::kCode);
    }

    void restart_fit() override {
        if (fit_) fit_->restart();
    }

    void forget_fits() override {
        if (fit_) fit_->forget();
    }

    Result<FileWriter> writer(const CodingParameters& parameters) const override {
        CodingParameters with_units = parameters;
        with_units.units = units_;
        if (is_rough_ || !codec_) return tiles_writer(made_.tiles, with_units);
        return tiles_writer(made_.tiles, with_units, [this](TilePyramid<int32_t>& pyramid, const Units& units) {
            codec_->repair(pyramid, units);
        });
    }

    std::vector<uint8_t> plane_exponents(uint32_t side) const override {
        return {tile_plane_exponent(made_.tiles, side)};
    }
    TexelGrid texel_grid(size_t, uint8_t exponent) const override {
        return tile_texels(made_.tiles, made_.atlas, exponent);
    }
    PlaneCoder analyse_plane(size_t, const TexelGrid& grid, std::vector<float> values, float) const override {
        return tile_plane_coder(made_.tiles, grid, values);
    }

  private:
    // Takes the tiles' samples from the atlas.
    void take_samples() {
        for (size_t texel = 0; texel < sample_at_.size(); ++texel) {
            if (sample_at_[texel] != kNone) made_.tiles.positions[sample_at_[texel]] = made_.atlas.positions[texel];
        }
    }

    MadeTiles made_;
    std::vector<uint32_t> sample_at_;  // per texel of the atlas
    bool is_rough_ = false;            // after a quick fit
    std::optional<CodedFit> fit_;
    TileCodec* codec_ = nullptr;  // of the fit
    std::optional<Units> units_;  // of the first fit
};

}  // namespace

Result<std::unique_ptr<LayoutImages>> tiles_layout(MadeTiles made, const Mesh& mesh, const EncodeOptions& options) {
    GIM_TRY(sample_at, samples_of_atlas(made.tiles));
    auto layout = std::make_unique<TilesLayout>(std::move(made), std::move(sample_at));
    if (is_fitted_to_codec(options)) GIM_CHECK(layout->make_fit(mesh, options));
    return std::unique_ptr<LayoutImages>(std::move(layout));
}

}  // namespace gim
