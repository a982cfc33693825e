#include "encoder/charts/write_charts.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/code/code_bands.h"
#include "encoder/code/extend_chart.h"
#include "encoder/code/file_units.h"
#include "format/chart_border.h"

namespace gim {
namespace {

Error error(std::string message) { return {Stage::kWrite, std::move(message)}; }

// Whether the format can hold the images.
Result<void> check(const ChartLevels& images, const CodingParameters& p) {
    if (images.charts.empty() || images.levels.empty()) return error("no chart to write");
    GIM_CHECK(check_bits(p.bits));
    if (images.charts.size() > kMaxCharts)
        return error(std::to_string(images.charts.size()) + " charts: the format takes " + std::to_string(kMaxCharts));
    if (images.mates.size() > kMaxChartPaths)
        return error(std::to_string(images.mates.size()) + " cut-paths: the format takes " +
                     std::to_string(kMaxChartPaths) + "; ask for fewer charts");
    if (std::max(images.image.mask.width, images.image.mask.height) > kMaxAtlasSide)
        return error("the image is too long for the format");
    for (size_t c = 0; c < images.charts.size(); ++c) {
        if (std::max(images.charts[c].columns, images.charts[c].rows) > kMaxChartSide)
            return error("chart " + std::to_string(c) + " is too long for the format; ask for more charts");
        for (const Vec3& position : images.positions[c]) {
            if (!is_codable(position))
                return error("chart " + std::to_string(c) + ": a position is not a finite number of reasonable size");
        }
    }
    return {};
}

// The positions of the defined samples: undefined ones do not count for the bounding box.
std::vector<Vec3> defined_positions(const ChartLevels& images) {
    std::vector<Vec3> positions;
    for (size_t c = 0; c < images.charts.size(); ++c) {
        for (size_t i = 0; i < images.positions[c].size(); ++i) {
            if (images.defined[c][i]) positions.push_back(images.positions[c][i]);
        }
    }
    return positions;
}

Units box_units(const ChartLevels& images, uint32_t bits) {
    const std::vector<Vec3> defined = defined_positions(images);
    const std::span<const Vec3> all = defined;
    return units_of_box({&all, 1}, bits);
}

// Base values relative to the one before.
void chain_base(Pyramid<int32_t>* pyramid) {
    for (size_t i = pyramid->base.size(); i-- > 3;) pyramid->base[i] -= pyramid->base[i - 3];
}

template <class Wavelet>
Pyramid<typename Wavelet::Sample> analyse_chart(const ChartLevels& images, size_t c, const Units& units, float finest) {
    using Sample = typename Wavelet::Sample;
    const ChartBox& box = images.charts[c];
    std::vector<Sample> samples = to_units<Sample>(images.positions[c], units);
    if (!images.is_extended) {
        samples =
            extend_chart<Wavelet>(std::move(samples), images.defined[c], box.columns, box.rows, box.steps(), finest);
    }
    Pyramid<Sample> pyramid = analyse<Wavelet>(std::move(samples), box.columns, box.rows, box.steps());
    subtract_middle(&pyramid, units.bits);
    return pyramid;
}

// Writes borders and zippers of one level. coarser: those of the next one, or null. paths: as the call for that level left
// them.
void code_borders(RangeEncoder& encoder, BorderModels& models, const std::vector<ChartBox>& charts,
                  const std::vector<uint32_t>& mates, LevelBorders borders, const LevelBorders* coarser, uint32_t level,
                  std::vector<BorderPath>& paths) {
    for (size_t p = 0; p < paths.size(); ++p) {
        paths[p].keep_as_coarse();
        paths[p].mate = mates[p];
        paths[p].length = borders.lengths[p];
    }
    std::vector<size_t> zipper_of(mates.size(), 0);  // of the path with the lower number
    for (size_t p = 0, next = 0; p < mates.size(); ++p) {
        if (mates[p] != kNoMate && mates[p] > p) zipper_of[p] = next++;
    }
    BorderCoder<RangeEncoder> coder(&encoder, &models);
    uint32_t first_path = 0;
    for (size_t c = 0; c < charts.size(); ++c) {
        BorderChart chart;
        chart.columns = halved(charts[c].columns, level);
        chart.rows = halved(charts[c].rows, level);
        chart.first_path = first_path;
        chart.path_count = charts[c].path_count;
        chart.border_length = static_cast<uint32_t>(borders.loops[c].size());
        borders.loops[c].resize(size_t{chart.columns} * chart.rows);
        chart.samples = borders.loops[c].data();
        if (coarser) {
            chart.coarse = coarser->loops[c].data();
            chart.coarse_columns = halved(chart.columns, 1);
            chart.coarse_border_length = static_cast<uint32_t>(coarser->loops[c].size());
        }
        (void)coder.code_border(chart, paths.data());
        for (uint32_t p = first_path; p < first_path + chart.path_count; ++p) {
            if (mates[p] >= p) continue;
            auto step = borders.zippers[zipper_of[mates[p]]].begin();
            (void)coder.code_zipper(
                paths[mates[p]], paths[p], [&] { return *step++; }, [](uint32_t, uint32_t) {});
        }
        first_path += chart.path_count;
    }
}

Header header_of(const ChartLevels& images, const CodingParameters& parameters) {
    Header header;
    header.layout = FileLayout::kCharts;
    header.coding = parameters.lossless ? Coding::kLossless : Coding::kLossy;
    header.width = images.image.mask.width;
    header.height = images.image.mask.height;
    header.level_count = static_cast<uint32_t>(images.levels.size());
    if (parameters.lossless) {
        static_cast<Units&>(header) = box_units(images, parameters.bits);
    } else {
        static_cast<Units&>(header) = parameters.units ? *parameters.units : chart_units(images, parameters.bits);
    }
    return header;
}

// The charts' part of a file.
class ChartCoder final : public LevelCoder {
  public:
    ChartCoder(const ChartLevels& images, const CodingParameters& parameters)
        : header_(header_of(images, parameters)),
          charts_(images.charts),
          mates_(images.mates),
          borders_(images.levels),
          repair_(parameters.lossless ? RepairBands() : parameters.repair) {
        const size_t count = charts_.size();
        const auto finest = static_cast<float>(parameters.lossless ? 1.0 : std::max(0.5, parameters.quantizer));
        bands_.lossless.resize(parameters.lossless ? count : 0);
        bands_.lossy.resize(parameters.lossless ? 0 : count);
        parallel_blocks(count, 1, 0, [&](size_t, size_t begin, size_t end) {
            for (size_t c = begin; c < end; ++c) {
                if (parameters.lossless) {
                    bands_.lossless[c] = analyse_chart<Reversible53>(images, c, header_, finest);
                } else {
                    bands_.lossy[c] = analyse_chart<Irreversible97>(images, c, header_, finest);
                }
            }
        });
    }

    Header header() const override { return header_; }
    std::vector<uint8_t> seam_payload() const override {
        ChartTable table{charts_, mates_, {}};
        for (const LevelBorders& level : borders_) table.levels.push_back(level.size);
        return serialize_chart_table(table, header_);
    }
    std::vector<std::vector<uint8_t>> code_levels(const Header& header) const override;

  private:
    Header header_;
    std::vector<ChartBox> charts_;
    std::vector<uint32_t> mates_;
    std::vector<LevelBorders> borders_;
    ImageBands bands_;  // per chart
    RepairBands repair_;
};

std::vector<std::vector<uint8_t>> ChartCoder::code_levels(const Header& header) const {
    uint32_t widest = 0;
    std::vector<Pyramid<int32_t>> bands;
    for (size_t c = 0; c < charts_.size(); ++c) {
        bands.push_back(bands_.quantized(c, header));
        widest = std::max(widest, charts_[c].columns);
    }
    if (repair_) repair_(0, bands, header);
    for (Pyramid<int32_t>& chart : bands) chain_base(&chart);
    BandModels models(coefficient_kind_of(header));
    BorderModels border_models;
    std::vector<BorderPath> paths(mates_.size());
    OwnBandWork work(widest);
    std::vector<std::vector<uint8_t>> levels;
    for (uint32_t level = header.level_count; level-- > 0;) {
        RangeEncoder encoder;
        const LevelBorders* coarser = level + 1 < header.level_count ? &borders_[level + 1] : nullptr;
        code_borders(encoder, border_models, charts_, mates_, borders_[level], coarser, level, paths);
        for (Pyramid<int32_t>& chart : bands) {
            BandCoder<RangeEncoder> coder(&encoder, &models, work.view());
            const uint32_t done = level + 1 == header.level_count ? 0 : chart.steps() - level - 1;
            code_steps(coder, chart, done, level);
        }
        levels.push_back(encoder.finish());
    }
    return levels;
}

}  // namespace

Units chart_units(const ChartLevels& images, uint32_t bits) {
    Units units = box_units(images, bits);
    CellArea area;
    for (size_t c = 0; c < images.charts.size(); ++c)
        area.add(images.positions[c], images.defined[c], images.charts[c].columns, images.charts[c].rows);
    area.set_details(&units);
    return units;
}

Result<FileWriter> charts_writer(const ChartLevels& images, const CodingParameters& parameters) {
    GIM_CHECK(check(images, parameters));
    return FileWriter(std::make_unique<ChartCoder>(images, parameters), parameters);
}

}  // namespace gim
