#include "decoder/charts/chart_decoder.h"

#include <algorithm>
#include <new>

#include "decoder/charts/close_charts.h"
#include "decoder/charts/zip_charts.h"

namespace gim {
namespace {

// Places charts in a level's grid. At full resolution they lie as in the rectangle. Coarser ones would run into each
// other there: they stand in shelves, with an empty row and column between them.
class GridLayout {
  public:
    GridLayout(const Header& header, const ChartLevelShape& shape, uint64_t padded_samples)
        : level_(shape.level), columns_(header.width), rows_(header.height) {
        if (level_ == 0) return;
        while (uint64_t{shelf_} * shelf_ < padded_samples) ++shelf_;
        shelf_ = std::max(shelf_, shape.widest + 1);
        columns_ = rows_ = 0;
    }
    void place(DecodedChart* chart) {
        if (level_ == 0) {
            chart->grid_column = static_cast<uint32_t>(chart->box.atlas_column);
            chart->grid_row = static_cast<uint32_t>(chart->box.atlas_row);
            return;
        }
        if (column_ + chart->columns + 1 > shelf_) {
            column_ = 0;
            row_ = rows_ + 1;
        }
        chart->grid_column = column_;
        chart->grid_row = row_;
        column_ += chart->columns + 1;
        columns_ = std::max(columns_, column_ - 1);
        rows_ = std::max(rows_, row_ + chart->rows);
    }
    uint32_t columns() const { return columns_; }
    uint32_t rows() const { return rows_; }

  private:
    uint32_t level_, shelf_ = 1, columns_, rows_;
    uint32_t column_ = 0, row_ = 0;
};

// Calls f(chart, number) for every chart of the table. Fills in its size, but not its place.
template <class F>
Status for_each_chart(std::span<const uint8_t> payload, const Header& header, const ContainerLimits& limits,
                      uint32_t level, uint32_t* mates, ChartTableReader* reader, const F& f) {
    if (Status s = reader->open(payload, header, limits); s != Status::kOk) return s;
    uint32_t first = 0;
    for (uint32_t c = 0; c < reader->chart_count(); ++c) {
        DecodedChart chart;
        const uint32_t first_path = reader->path_count();
        if (Status s = reader->next(&chart.box, mates); s != Status::kOk) return s;
        chart.columns = halved(chart.box.columns, level);
        chart.rows = halved(chart.box.rows, level);
        chart.first = first;
        first += chart.columns * chart.rows;
        chart.border.columns = chart.columns;
        chart.border.rows = chart.rows;
        chart.border.first_path = first_path;
        chart.border.path_count = chart.box.path_count;
        f(chart, c);
    }
    return reader->finish();
}

// The bands and images of one chart, cut out of those of all.
PyramidWorkspace planes_of(const ChartWorkspace& ws, size_t first, size_t low_first) {
    PyramidWorkspace planes = ws.pyramid;
    planes.bands[0] += first * 3;
    planes.bands[1] += low_first * 3;
    planes.images[0] = static_cast<float*>(planes.images[0]) + first * 3;
    planes.images[1] = static_cast<float*>(planes.images[1]) + low_first * 3;
    return planes;
}

// Decodes the steps of a chart that one stream holds, from its base or from the level before.
bool decode_chart(const Header& header, const ChartLevelShape& shape, const DecodedChart& chart,
                  const PyramidWorkspace& planes, RangeDecoder& decoder, uint32_t stream_level) {
    const PyramidShape pyramid = {chart.box.columns,
                                  chart.box.rows,
                                  chart.box.steps(),
                                  shape.level,
                                  detail_coding_of(header),
                                  1 << (header.bits - 1),
                                  true};
    const uint32_t done = stream_level + 1 == header.level_count ? 0 : chart.box.steps() - stream_level - 1;
    PyramidDecoder image(header.coding == Coding::kLossless, pyramid, planes, done);
    BandDecoder coder(&decoder, planes.models, planes.band_work);
    return image.advance(coder, stream_level);
}

Status decode_levels(const Header& header, std::span<const uint8_t> file, const ChartLevelShape& shape,
                     const ChartWorkspace& ws) {
    new (ws.pyramid.models) BandModels(coefficient_kind_of(header));
    new (ws.border_models) BorderModels();
    for (uint32_t l = header.level_count; l-- > shape.level;) {
        Chunk chunk;
        uint64_t offset = 0;
        std::span<const uint8_t> payload;
        if (Status s = find_level_chunk(header, l, &chunk, &offset); s != Status::kOk) return s;
        if (Status s = read_payload(file, chunk, offset, &payload); s != Status::kOk) return s;
        RangeDecoder decoder(payload);
        if (!read_borders(shape, ws, l, l + 1 == header.level_count, decoder)) return Status::kMalformed;
        size_t low_first = 0;
        for (uint32_t c = 0; c < shape.chart_count; ++c) {
            const DecodedChart& chart = ws.charts[c];
            const PyramidWorkspace planes = planes_of(ws, chart.first, low_first);
            if (!decode_chart(header, shape, chart, planes, decoder, l)) return Status::kMalformed;
            low_first += size_t{low_count(chart.columns)} * low_count(chart.rows);
        }
        if (!decoder.intact()) return Status::kMalformed;
    }
    return Status::kOk;
}

}  // namespace

Status open_charts(const Header& header, std::span<const uint8_t> file, const ContainerLimits& limits, uint32_t level,
                   ChartLevelShape* shape) {
    std::span<const uint8_t> payload;
    if (Status s = read_seam_payload(header, file, &payload); s != Status::kOk) return s;
    if (level >= header.level_count) return Status::kNoSuchLevel;
    *shape = {};
    shape->level = level;
    uint64_t padded = 0;
    ChartTableReader reader;
    if (Status s = for_each_chart(payload, header, limits, level, nullptr, &reader,
                                  [&](const DecodedChart& chart, uint32_t) {
                                      shape->samples += uint64_t{chart.columns} * chart.rows;
                                      shape->low_samples += uint64_t{low_count(chart.columns)} * low_count(chart.rows);
                                      shape->widest = std::max(shape->widest, chart.columns);
                                      padded += uint64_t{chart.columns + 1} * (chart.rows + 1);
                                  });
        s != Status::kOk)
        return s;
    if (shape->samples > INT32_MAX) return Status::kLimitExceeded;  // flat indices, and triangles, have 32 bits
    shape->chart_count = reader.chart_count();
    shape->path_count = reader.path_count();
    shape->size = reader.level(level);
    if (shape->size.vertices > shape->samples || shape->size.triangles > 2 * shape->samples) return Status::kMalformed;
    GridLayout layout(header, *shape, padded);
    if (level > 0) {
        if (Status s = for_each_chart(payload, header, limits, level, nullptr, &reader,
                                      [&](DecodedChart& chart, uint32_t) { layout.place(&chart); });
            s != Status::kOk)
            return s;
    }
    shape->columns = layout.columns();
    shape->rows = layout.rows();
    // Wide boxes beside tall ones make shelves that are mostly empty.
    return uint64_t{shape->columns} * shape->rows > limits.max_samples ? Status::kLimitExceeded : Status::kOk;
}

ChartWorkspace lay_out_charts(const ChartLevelShape& shape, Arena* arena) {
    ChartWorkspace ws;
    const auto samples = static_cast<size_t>(shape.samples), low = static_cast<size_t>(shape.low_samples);
    lay_out_coder(shape.widest, arena, &ws.pyramid);
    ws.pyramid.bands[0] = arena->take<int32_t>(samples * 3);
    ws.pyramid.bands[1] = arena->take<int32_t>(low * 3);
    ws.pyramid.images[0] = arena->take<float>(samples * 3);
    ws.pyramid.images[1] = arena->take<float>(low * 3);
    ws.charts = arena->take<DecodedChart>(shape.chart_count);
    ws.paths = arena->take<BorderPath>(shape.path_count);
    ws.mates = arena->take<uint32_t>(shape.path_count);
    ws.border_models = arena->take<BorderModels>(1);
    ws.border = arena->take<uint32_t>(samples);
    ws.point = arena->take<uint32_t>(samples);
    ws.depth = arena->take<uint8_t>(samples);
    ws.queue = arena->take<uint32_t>(samples);
    // Bands are not needed any more when seams are closed.
    ws.corrections = static_cast<float*>(static_cast<void*>(ws.pyramid.bands[0]));
    ws.members = arena->take<uint32_t>(shape.size.vertices);
    ws.sums = arena->take<float>(size_t{shape.size.vertices} * 3);
    return ws;
}

Status decode_charts(const Header& header, std::span<const uint8_t> file, const ContainerLimits& limits,
                     const ChartLevelShape& shape, const ChartWorkspace& ws, const float** samples) {
    std::span<const uint8_t> payload;
    if (Status s = read_seam_payload(header, file, &payload); s != Status::kOk) return s;
    uint64_t padded = 0;
    ChartTableReader reader;
    const Status status = for_each_chart(payload, header, limits, shape.level, ws.mates, &reader,
                                         [&](const DecodedChart& chart, uint32_t c) {
                                             new (&ws.charts[c]) DecodedChart(chart);
                                             padded += uint64_t{chart.columns + 1} * (chart.rows + 1);
                                         });
    if (status != Status::kOk) return status;
    GridLayout layout(header, shape, padded);
    for (uint32_t c = 0; c < shape.chart_count; ++c) {
        DecodedChart& chart = ws.charts[c];
        layout.place(&chart);
        for (uint32_t k = 0; k < chart.border.path_count; ++k) {
            const uint32_t p = chart.border.first_path + k;
            new (&ws.paths[p]) BorderPath{ws.mates[p], 0, 0, c, 0, 0};
        }
    }
    if (Status s = decode_levels(header, file, shape, ws); s != Status::kOk) return s;
    if (number_points(shape, ws) != shape.size.vertices) return Status::kMalformed;
    const size_t count = static_cast<size_t>(shape.samples) * 3;
    float* units = to_units(header.coding == Coding::kLossless, ws.pyramid.images[0], count);
    close_charts(shape, ws, units);
    *samples = units;
    return Status::kOk;
}

}  // namespace gim
