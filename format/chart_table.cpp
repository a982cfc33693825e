#include "format/chart_table.h"

#include <algorithm>
#include <bit>

#include "format/bytes.h"

namespace gim {
namespace {

constexpr uint32_t kMostMargin = 4096;

// Elias gamma code of n >= 1: as many zeros as n has binary digits after the first one, then n.
void write_gamma(uint32_t n, BitWriter* bits) {
    const int width = std::bit_width(n);
    bits->write(0, width - 1);
    bits->write(n, width);
}
bool read_gamma(BitReader* bits, uint32_t* n) {
    int zeros = 0;
    for (uint32_t bit = 0;; ++zeros) {
        if (zeros == 24 || !bits->read(1, &bit)) return false;
        if (bit) break;
    }
    uint32_t rest = 0;
    if (!bits->read(zeros, &rest)) return false;
    *n = 1u << zeros | rest;
    return true;
}

}  // namespace

uint32_t halvings(uint32_t columns, uint32_t rows) {
    uint32_t steps = 0;
    for (uint32_t least = std::min(columns, rows); least >= 3; least -= least / 2) ++steps;
    return std::min(steps, kMaxLevels);
}

Status ChartTableReader::open(std::span<const uint8_t> payload, const Header& header, const ContainerLimits& limits) {
    ByteReader reader(payload);
    uint64_t charts = 0, margin = 0;
    uint8_t box_bits = 0;
    if (!reader.read_leb128(&charts) || !reader.read_leb128(&margin) || !reader.read_u8(&box_bits))
        return Status::kMalformed;
    if (charts == 0 || charts > kMaxCharts || margin > kMostMargin || box_bits == 0 ||
        box_bits > std::bit_width(kMaxChartSide - 1))
        return Status::kMalformed;
    chart_count_ = static_cast<uint32_t>(charts);
    margin_ = static_cast<uint32_t>(margin);
    box_bits_ = box_bits;
    width_ = header.width;
    height_ = header.height;
    level_count_ = header.level_count;
    most_samples_ = limits.max_samples;
    for (uint32_t l = 0; l < level_count_; ++l) {
        uint64_t vertices = 0, triangles = 0;
        if (!reader.read_leb128(&vertices) || !reader.read_leb128(&triangles)) return Status::kMalformed;
        if (vertices < 3 || triangles < 1 || vertices > UINT32_MAX || triangles > UINT32_MAX / 3)
            return Status::kMalformed;
        levels_[l] = {static_cast<uint32_t>(vertices), static_cast<uint32_t>(triangles)};
    }
    bits_ = BitReader(payload.subspan(reader.position()));
    samples_ = path_count_ = open_count_ = 0;
    return Status::kOk;
}

Status ChartTableReader::next(ChartBox* chart, uint32_t* mates) {
    const int bits = static_cast<int>(box_bits_);
    uint32_t columns = 0, rows = 0, column = 0, row = 0, paths = 0;
    if (!bits_.read(bits, &columns) || !bits_.read(bits, &rows) || !bits_.read_up_to(width_ - 1 + margin_, &column) ||
        !bits_.read_up_to(height_ - 1 + margin_, &row) || !read_gamma(&bits_, &paths))
        return Status::kMalformed;
    *chart = {columns + 1, rows + 1, static_cast<int32_t>(column) - static_cast<int32_t>(margin_),
              static_cast<int32_t>(row) - static_cast<int32_t>(margin_), paths};
    if (columns < 1 || rows < 1 || chart->steps() + 1 < level_count_) return Status::kMalformed;
    samples_ += uint64_t{chart->columns} * chart->rows;  // at most 2^13 * 2^30
    if (samples_ > most_samples_) return Status::kLimitExceeded;
    return read_paths(paths, mates);
}

Status ChartTableReader::read_paths(uint32_t count, uint32_t* mates) {
    if (count > kMaxChartPaths - path_count_) return Status::kMalformed;
    for (const uint32_t end = path_count_ + count; path_count_ < end; ++path_count_) {
        uint32_t bit = 0, back = 0;
        if (!bits_.read(1, &bit)) return Status::kMalformed;
        if (bit) {  // the mate of an open path
            if (open_count_ == 0 || !bits_.read_up_to(open_count_ - 1, &back)) return Status::kMalformed;
            const uint32_t at = open_count_ - 1 - back, mate = open_[at];
            std::copy(open_.begin() + at + 1, open_.begin() + open_count_, open_.begin() + at);
            --open_count_;
            if (mates) mates[path_count_] = mate, mates[mate] = path_count_;
            continue;
        }
        if (!bits_.read(1, &bit)) return Status::kMalformed;
        if (mates) mates[path_count_] = kNoMate;
        if (!bit) continue;
        if (open_count_ == open_.size()) return Status::kMalformed;
        open_[open_count_++] = static_cast<uint16_t>(path_count_);
    }
    return Status::kOk;
}

Status ChartTableReader::finish() {
    return open_count_ == 0 && bits_.rest_is_zero() && bits_.at_end() ? Status::kOk : Status::kMalformed;
}

std::vector<uint8_t> serialize_chart_table(const ChartTable& table, const Header& header) {
    uint32_t margin = 0, largest = 0;
    for (const ChartBox& chart : table.charts) {
        margin = static_cast<uint32_t>(std::max({static_cast<int32_t>(margin), -chart.atlas_column, -chart.atlas_row}));
        largest = std::max({largest, chart.columns - 1, chart.rows - 1});
    }
    std::vector<uint8_t> payload;
    append_leb128(table.charts.size(), &payload);
    append_leb128(margin, &payload);
    const int box_bits = std::bit_width(largest);
    payload.push_back(static_cast<uint8_t>(box_bits));
    for (const LevelSize& level : table.levels) {
        append_leb128(level.vertices, &payload);
        append_leb128(level.triangles, &payload);
    }
    BitWriter bits(&payload);
    std::vector<uint32_t> open;
    uint32_t path = 0;
    for (const ChartBox& chart : table.charts) {
        bits.write(chart.columns - 1, box_bits);
        bits.write(chart.rows - 1, box_bits);
        bits.write_up_to(static_cast<uint32_t>(chart.atlas_column + static_cast<int32_t>(margin)),
                         header.width - 1 + margin);
        bits.write_up_to(static_cast<uint32_t>(chart.atlas_row + static_cast<int32_t>(margin)),
                         header.height - 1 + margin);
        write_gamma(chart.path_count, &bits);
        for (const uint32_t end = path + chart.path_count; path < end; ++path) {
            const uint32_t mate = table.mates[path];
            if (mate == kNoMate) {
                bits.write(0, 2);
            } else if (mate > path) {
                bits.write(1, 2);
                open.push_back(path);
            } else {
                const auto at = std::find(open.begin(), open.end(), mate);
                bits.write(1, 1);
                bits.write_up_to(static_cast<uint32_t>(open.end() - at) - 1, static_cast<uint32_t>(open.size()) - 1);
                open.erase(at);
            }
        }
    }
    return payload;
}

}  // namespace gim
