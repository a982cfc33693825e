#include "decoder/charts/zip_charts.h"

#include <algorithm>
#include <cstring>

namespace gim {
namespace {

struct BorderReader {
    const ChartLevelShape& shape;
    const ChartWorkspace& ws;
    bool glue;
    bool follows;  // a coarser level, which was read before

    bool read(RangeDecoder& decoder, uint32_t shift) {
        BorderCoder<RangeDecoder> coder(&decoder, ws.border_models);
        for (uint32_t c = 0; c < shape.chart_count; ++c) {
            DecodedChart& chart = ws.charts[c];
            BorderChart border = chart.border;
            border.columns = halved(chart.columns, shift);
            border.rows = halved(chart.rows, shift);
            border.samples = ws.border + chart.first;
            if (follows) keep_coarse(chart, shift, border);
            if (!coder.code_border(border, ws.paths)) return false;
            chart.border.border_length = border.border_length;
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
    // Moves the border of the coarser level out of the way. It guides the one that is read next.
    void keep_coarse(const DecodedChart& chart, uint32_t shift, BorderChart& border) const {
        uint32_t* coarse = ws.queue + chart.first;
        border.coarse_border_length = chart.border.border_length;
        border.coarse_columns = halved(chart.columns, shift + 1);
        std::copy_n(border.samples, border.coarse_border_length, coarse);
        border.coarse = coarse;
        for (uint32_t p = border.first_path; p < border.first_path + border.path_count; ++p)
            ws.paths[p].keep_as_coarse();
    }
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

    // Finds the samples inside the border. Returns false if the border meets itself.
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
            uint8_t *d = depth + size_t{row} * columns, *end = d + columns;
            while (d < end) {
                uint64_t group = 1;
                if (end - d >= 8) std::memcpy(&group, d, 8);
                if (group == 0) {  // eight samples without a border
                    std::fill_n(d, 8, inside ? kInside : kUndefined);
                    d += 8;
                    continue;
                }
                inside ^= *d & kToggleBit;
                *d = *d & kBorderBit ? kOnBorder : inside ? kInside : kUndefined;
                ++d;
            }
        }
        for (uint32_t k = 0; k < length; ++k) {
            const uint32_t i = chart.first + chart.border.samples[k];
            ws.point[i] = i;
        }
        return true;
    }
};

}  // namespace

bool read_borders(const ChartLevelShape& shape, const ChartWorkspace& ws, uint32_t stream_level, bool is_coarsest,
                  RangeDecoder& decoder) {
    BorderReader reader{shape, ws, stream_level == shape.level, !is_coarsest};
    return reader.read(decoder, stream_level - shape.level);
}

uint32_t number_points(const ChartLevelShape& shape, const ChartWorkspace& ws) {
    uint32_t next = 0;
    for (uint32_t i = 0; i < shape.samples; ++i) {
        if (ws.depth[i] == kUndefined) continue;
        if (ws.depth[i] != kOnBorder) {
            ws.point[i] = next++;
            continue;
        }
        // A parent's own entry holds its number already.
        const uint32_t parent = ws.point[i];
        ws.point[i] = parent == i ? next++ : ws.point[parent];
    }
    return next;
}

}  // namespace gim
