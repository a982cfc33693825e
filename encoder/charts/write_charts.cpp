#include "encoder/charts/write_charts.h"

#include <algorithm>
#include <cmath>

#include "encoder/base/parallel.h"
#include "encoder/code/code_bands.h"
#include "encoder/code/extend_chart.h"
#include "format/chart_border.h"

namespace gim {
namespace {

Error error(std::string message) { return {Stage::kWrite, std::move(message)}; }

// Empty when all is well.
std::string complaint(const ChartImages& images, const CodingParameters& p) {
    if (images.charts.empty() || images.levels.empty()) return "no chart to write";
    if (p.bits < kMinBits || p.bits > kMaxBits) return "bits " + std::to_string(p.bits) + ": choose 8 to 20";
    if (images.charts.size() > kMaxCharts)
        return std::to_string(images.charts.size()) + " charts: the format takes " + std::to_string(kMaxCharts);
    if (images.mates.size() > kMaxChartPaths)
        return std::to_string(images.mates.size()) + " cut-paths: the format takes " + std::to_string(kMaxChartPaths) +
               "; ask for fewer charts";
    if (images.image.width() > kMaxAtlasSide || images.image.height() > kMaxAtlasSide)
        return "the image is too long for the format";
    for (size_t c = 0; c < images.charts.size(); ++c) {
        if (std::max(images.charts[c].columns, images.charts[c].rows) > kMaxChartSide)
            return "chart " + std::to_string(c) + " is too long for the format; ask for more charts";
        for (const Vec3& position : images.positions[c]) {
            if (!position.allFinite() || position.cwiseAbs().maxCoeff() > double{kMaxOrigin})
                return "chart " + std::to_string(c) + ": a position is not a finite number of reasonable size";
        }
    }
    return {};
}

// The positions of the defined samples: undefined ones do not count for the bounding box.
std::vector<Vec3> defined_positions(const ChartImages& images) {
    std::vector<Vec3> positions;
    for (size_t c = 0; c < images.charts.size(); ++c) {
        for (size_t i = 0; i < images.positions[c].size(); ++i) {
            if (images.defined[c][i]) positions.push_back(images.positions[c][i]);
        }
    }
    return positions;
}

// Base values relative to the one before.
void chain_base(Pyramid<int32_t>* pyramid) {
    for (size_t i = pyramid->base.size(); i-- > 3;) pyramid->base[i] -= pyramid->base[i - 3];
}

template <class Wavelet>
Pyramid<typename Wavelet::Sample> analyse_chart(const ChartImages& images, size_t c, const Header& header,
                                                float finest) {
    using Sample = typename Wavelet::Sample;
    const ChartBox& box = images.charts[c];
    std::vector<Sample> units = to_units<Sample>(images.positions[c], header);
    units = extend_chart<Wavelet>(std::move(units), images.defined[c], box.columns, box.rows, box.steps(), finest);
    Pyramid<Sample> pyramid = analyse<Wavelet>(std::move(units), box.columns, box.rows, box.steps());
    subtract_middle(&pyramid, header.bits);
    return pyramid;
}

// Writes borders and zippers of one level.
void code_borders(RangeEncoder& encoder, BorderModels& models, const std::vector<ChartBox>& charts,
                  const std::vector<uint32_t>& mates, LevelBorders borders, uint32_t level) {
    std::vector<BorderPath> paths(mates.size());
    for (size_t p = 0; p < paths.size(); ++p) paths[p] = {mates[p], borders.lengths[p], 0, 0};
    std::vector<size_t> zipper_of(mates.size(), 0);  // of the path with the lower number
    for (size_t p = 0, next = 0; p < mates.size(); ++p) {
        if (mates[p] != kUnmated && mates[p] > p) zipper_of[p] = next++;
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

}  // namespace

Result<ChartFileWriter> ChartFileWriter::create(const ChartImages& images, const CodingParameters& parameters) {
    if (std::string c = complaint(images, parameters); !c.empty()) return error(std::move(c));
    ChartFileWriter writer;
    Header& header = writer.header_;
    header.layout = FileLayout::kCharts;
    header.coding = parameters.lossless ? Coding::kLossless : Coding::kLossy;
    header.width = images.image.width();
    header.height = images.image.height();
    header.level_count = static_cast<uint32_t>(images.levels.size());
    const std::vector<Vec3> defined = defined_positions(images);
    const std::span<const Vec3> all = defined;
    set_quantizer({&all, 1}, parameters.bits, &header);
    if (header.coding == Coding::kLossy) {
        CellArea area;
        for (size_t c = 0; c < images.charts.size(); ++c)
            area.add(images.positions[c], images.defined[c], images.charts[c].columns, images.charts[c].rows);
        area.set_details(&header);
    }
    writer.charts_ = images.charts;
    writer.mates_ = images.mates;
    writer.borders_ = images.levels;
    writer.planes_ = parameters.planes;
    writer.text_ = parameters.text;
    if (parameters.level_psnr) writer.level_psnr_.assign(header.level_count, 0);

    ChartTable table{images.charts, images.mates, {}};
    for (const LevelBorders& level : images.levels) table.levels.push_back(level.size);
    writer.table_ = serialize_chart_table(table, header);

    const size_t count = images.charts.size();
    const auto finest = static_cast<float>(parameters.lossless ? 1.0 : std::max(0.5, parameters.quantizer));
    writer.lossless_.resize(parameters.lossless ? count : 0);
    writer.lossy_.resize(parameters.lossless ? 0 : count);
    parallel_blocks(count, 1, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) {
            if (parameters.lossless) {
                writer.lossless_[c] = analyse_chart<Reversible53>(images, c, header, finest);
            } else {
                writer.lossy_[c] = analyse_chart<Irreversible97>(images, c, header, finest);
            }
        }
    });
    return writer;
}

std::vector<uint8_t> ChartFileWriter::write(double quantizer) const {
    Header header = header_;
    header.level_psnr = level_psnr_;
    if (header.coding == Coding::kLossy) header.quantizer = quantizer_in_range(quantizer);

    uint32_t widest = 0;
    std::vector<Pyramid<int32_t>> bands;
    for (size_t c = 0; c < charts_.size(); ++c) {
        bands.push_back(header.coding == Coding::kLossless ? lossless_[c]
                                                           : quantize_bands(lossy_[c], detail_coding_of(header)).bands);
        chain_base(&bands.back());
        widest = std::max(widest, charts_[c].columns);
    }
    BandModels models(coefficient_kind_of(header));
    BorderModels border_models;
    OwnBandWork work(widest);
    std::vector<std::vector<uint8_t>> levels;
    for (uint32_t level = header.level_count; level-- > 0;) {
        RangeEncoder encoder;
        code_borders(encoder, border_models, charts_, mates_, borders_[level], level);
        for (Pyramid<int32_t>& chart : bands) {
            BandCoder<RangeEncoder> coder(&encoder, &models, work.view());
            const uint32_t done = level + 1 == header.level_count ? 0 : chart.steps() - level - 1;
            code_steps(coder, chart, done, level);
        }
        levels.push_back(encoder.finish());
    }
    return assemble_file(header, table_, levels, planes_, text_);
}

}  // namespace gim
