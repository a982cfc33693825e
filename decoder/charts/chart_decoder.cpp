#include "decoder/charts/chart_decoder.h"

#include <algorithm>
#include <array>
#include <new>

namespace gim {
namespace {

// Where charts lie in a level's grid. At full resolution in the rectangle; coarser ones, which would run into each other
// there, in shelves, an empty row and column between them.
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

// Calls f(chart, number) for every chart of the table; its size, but not its place, is filled in.
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

// ---- borders

// Reads the borders and zippers of a level; with `glue` also glues: ws.point is then a forest over flat samples in which
// parents come before their children.
struct BorderReader {
    const ChartLevelShape& shape;
    const ChartWorkspace& ws;
    bool glue;

    bool read(RangeDecoder& decoder, uint32_t shift) {
        BorderCoder<RangeDecoder> coder(&decoder, ws.border_models);
        for (uint32_t c = 0; c < shape.chart_count; ++c) {
            DecodedChart& chart = ws.charts[c];
            BorderChart border = chart.border;
            border.columns = halved(chart.columns, shift);
            border.rows = halved(chart.rows, shift);
            border.samples = ws.border + chart.first;
            if (!coder.code_border(border, ws.paths)) return false;
            if (glue) {
                chart.border = border;
                if (!mark(chart)) return false;
            }
            for (uint32_t p = border.first_path; p < border.first_path + border.path_count; ++p) {
                if (ws.paths[p].mate >= p) continue;
                if (!read_zipper(coder, p)) return false;
            }
        }
        return true;
    }

  private:
    bool read_zipper(BorderCoder<RangeDecoder>& coder, uint32_t p) {
        const BorderPath &first = ws.paths[ws.paths[p].mate], &second = ws.paths[p];
        const auto none = [] { return ZipStep::kBoth; };
        if (!glue) return coder.code_zipper(first, second, none, [](uint32_t, uint32_t) {});
        return coder.code_zipper(first, second, none, [&](uint32_t i, uint32_t j) {
            unite(sample_of(first, i), sample_of(second, second.length - j));
        });
    }
    uint32_t sample_of(const BorderPath& path, uint32_t i) const {
        const DecodedChart& chart = ws.charts[path.chart];
        uint32_t k = path.first + i;
        if (k >= chart.border.border_length) k -= chart.border.border_length;
        return chart.first + chart.border.samples[k];
    }
    uint32_t root(uint32_t i) const {
        while (ws.point[i] != i) i = ws.point[i] = ws.point[ws.point[i]];
        return i;
    }
    void unite(uint32_t a, uint32_t b) const {
        a = root(a);
        b = root(b);
        ws.point[std::max(a, b)] = std::min(a, b);
    }

    // Finds the samples inside the border. False when the border meets itself.
    bool mark(DecodedChart& chart) const {
        constexpr uint8_t kBorderBit = 1, kToggleBit = 2;
        uint8_t* depth = ws.depth + chart.first;
        const uint32_t columns = chart.columns, count = columns * chart.rows;
        std::fill_n(depth, count, uint8_t{0});
        const uint32_t length = chart.border.border_length;
        for (uint32_t k = 0; k < length; ++k) {
            const uint32_t a = chart.border.samples[k], b = chart.border.samples[k + 1 < length ? k + 1 : 0];
            if (depth[a] & kBorderBit) return false;
            depth[a] |= kBorderBit;
            // An edge that leads to another row toggles all samples to the right of its upper end.
            if (a / columns != b / columns) depth[std::min(a, b)] ^= kToggleBit;
        }
        for (uint32_t row = 0; row < chart.rows; ++row) {
            uint8_t inside = 0;
            for (uint8_t* d = depth + size_t{row} * columns; d < depth + size_t{row + 1} * columns; ++d) {
                inside ^= *d & kToggleBit;
                *d = *d & kBorderBit ? kOnBorder : inside ? kInside : kUndefined;
            }
        }
        for (uint32_t i = 0; i < count; ++i) ws.point[chart.first + i] = chart.first + i;
        return true;
    }
};

// Turns the forest into vertex numbers, by first appearance. Returns how many there are.
uint32_t number_points(const ChartLevelShape& shape, const ChartWorkspace& ws) {
    uint32_t next = 0;
    for (uint32_t i = 0; i < shape.samples; ++i) {
        if (ws.depth[i] == kUndefined) continue;
        // A parent's own entry holds its number already.
        const uint32_t parent = ws.point[i];
        ws.point[i] = parent == i ? next++ : ws.point[parent];
    }
    return next;
}

// ---- closing the seams

// Means over the points of the borders; corrections of their samples. False when nothing changes.
bool average_points(const ChartLevelShape& shape, const ChartWorkspace& ws, float* samples) {
    std::fill_n(ws.members, shape.size.vertices, 0u);
    // The first sample of a point stands in `queue` while sums are made.
    for (uint32_t i = 0; i < shape.samples; ++i) {
        if (ws.depth[i] != kOnBorder) continue;
        const uint32_t v = ws.point[i];
        float* sum = ws.sums + size_t{v} * 3;
        if (ws.members[v]++ == 0) {
            ws.queue[v] = i;
            std::fill_n(sum, 3, 0.0f);
            continue;
        }
        const float *x = samples + size_t{i} * 3, *x0 = samples + size_t{ws.queue[v]} * 3;
        for (int k = 0; k < 3; ++k) sum[k] = sum[k] + (x[k] - x0[k]);
    }
    for (uint32_t v = 0; v < shape.size.vertices; ++v) {
        if (ws.members[v] == 0) continue;
        const float* x0 = samples + size_t{ws.queue[v]} * 3;
        float* mean = ws.sums + size_t{v} * 3;
        for (int k = 0; k < 3; ++k) mean[k] = x0[k] + mean[k] / static_cast<float>(ws.members[v]);
    }
    bool changed = false;
    for (uint32_t i = 0; i < shape.samples; ++i) {
        if (ws.depth[i] != kOnBorder) continue;
        const float* mean = ws.sums + size_t{ws.point[i]} * 3;
        for (size_t k = 0; k < 3; ++k) {
            float& x = samples[size_t{i} * 3 + k];
            ws.corrections[size_t{i} * 3 + k] = mean[k] - x;
            changed |= mean[k] != x;
            x = mean[k];
        }
    }
    return changed;
}

// Spreads the corrections inwards, layer by layer: each sample gets a part of the mean of those around it that lie one step
// nearer to the border.
void diffuse(const DecodedChart& chart, const ChartWorkspace& ws, float* samples) {
    const uint32_t width = chart_diffusion_width(chart.columns, chart.rows);
    uint8_t* depth = ws.depth + chart.first;
    float* corrections = ws.corrections + size_t{chart.first} * 3;
    float* x = samples + size_t{chart.first} * 3;
    uint32_t* queue = ws.queue;
    uint32_t begin = 0, end = 0;
    for (uint32_t k = 0; k < chart.border.border_length; ++k) queue[end++] = chart.border.samples[k];
    // A sample inside has all its eight neighbours in the box.
    const auto stride = static_cast<int32_t>(chart.columns);
    const std::array<int32_t, 8> around = {-stride - 1, -stride, -stride + 1, -1, 1, stride - 1, stride, stride + 1};
    const auto neighbour = [](uint32_t i, int32_t offset) { return i + static_cast<uint32_t>(offset); };
    for (uint32_t layer = 1; layer <= width; ++layer) {
        const uint32_t last = end;
        for (; begin < last; ++begin) {
            const uint32_t row = queue[begin] / chart.columns, column = queue[begin] % chart.columns;
            for (const int32_t offset : around) {
                const bool outside =
                    (column == 0 && (offset == -1 || offset == stride - 1 || offset == -stride - 1)) ||
                    (column + 1 == chart.columns && (offset == 1 || offset == stride + 1 || offset == -stride + 1)) ||
                    (row == 0 && offset < -1) || (row + 1 == chart.rows && offset > 1);
                if (outside) continue;
                const uint32_t i = neighbour(queue[begin], offset);
                if (depth[i] != kInside) continue;
                depth[i] = static_cast<uint8_t>(layer);
                queue[end++] = i;
            }
        }
        const float decay = static_cast<float>(width + 1 - layer) / static_cast<float>(width + 2 - layer);
        for (uint32_t q = last; q < end; ++q) {
            const uint32_t i = queue[q];
            float sum[3] = {0, 0, 0};
            uint32_t count = 0;
            for (const int32_t offset : around) {
                const uint32_t j = neighbour(i, offset);
                if (depth[j] + 1u != layer) continue;
                for (size_t k = 0; k < 3; ++k) sum[k] = sum[k] + corrections[size_t{j} * 3 + k];
                ++count;
            }
            for (size_t k = 0; k < 3; ++k) {
                const float correction = decay * (sum[k] / static_cast<float>(count));
                corrections[size_t{i} * 3 + k] = correction;
                x[size_t{i} * 3 + k] = x[size_t{i} * 3 + k] + correction;
            }
        }
    }
}

// ---- samples

// The planes of one chart, cut out of those of all.
PyramidWorkspace planes_of(const ChartWorkspace& ws, size_t first, size_t low_first) {
    PyramidWorkspace planes = ws.pyramid;
    planes.bands[0] += first * 3;
    planes.bands[1] += low_first * 3;
    planes.images[0] = static_cast<float*>(planes.images[0]) + first * 3;
    planes.images[1] = static_cast<float*>(planes.images[1]) + low_first * 3;
    return planes;
}

// The steps of a chart that one stream holds, from its base or from the level before.
template <class Wavelet>
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
    PyramidDecoder<Wavelet> image(pyramid, planes, done);
    BandCoder<RangeDecoder> coder(&decoder, planes.models, planes.band_work);
    return image.advance(coder, stream_level);
}

template <class Wavelet>
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
        BorderReader borders{shape, ws, l == shape.level};
        if (!borders.read(decoder, l - shape.level)) return Status::kMalformed;
        size_t low_first = 0;
        for (uint32_t c = 0; c < shape.chart_count; ++c) {
            const DecodedChart& chart = ws.charts[c];
            const PyramidWorkspace planes = planes_of(ws, chart.first, low_first);
            if (!decode_chart<Wavelet>(header, shape, chart, planes, decoder, l)) return Status::kMalformed;
            low_first += size_t{low_count(chart.columns)} * low_count(chart.rows);
        }
        if (!decoder.intact()) return Status::kMalformed;
    }
    return Status::kOk;
}

}  // namespace

uint32_t chart_diffusion_width(uint32_t columns, uint32_t rows) {
    return std::clamp(std::min(columns, rows) / 8, 2u, 16u);
}

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
    // Long boxes this way and that make shelves of mostly nothing.
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
    ws.corrections = arena->take<float>(samples * 3);
    ws.members = arena->take<uint32_t>(samples);
    ws.sums = arena->take<float>(samples * 3);
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
            new (&ws.paths[p]) BorderPath{ws.mates[p], 0, 0, c};
        }
    }
    const bool lossless = header.coding == Coding::kLossless;
    if (Status s = lossless ? decode_levels<Reversible53>(header, file, shape, ws)
                            : decode_levels<Irreversible97>(header, file, shape, ws);
        s != Status::kOk)
        return s;
    if (number_points(shape, ws) != shape.size.vertices) return Status::kMalformed;
    const size_t count = static_cast<size_t>(shape.samples) * 3;
    float* units =
        lossless ? to_units<int32_t>(ws.pyramid.images[0], count) : to_units<float>(ws.pyramid.images[0], count);
    if (average_points(shape, ws, units)) {
        for (uint32_t c = 0; c < shape.chart_count; ++c) diffuse(ws.charts[c], ws, units);
    }
    *samples = units;
    return Status::kOk;
}

}  // namespace gim
