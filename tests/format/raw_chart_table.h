// A chart table and a level's borders, field by field as in spec/gim-format.md 11.1 and 11.3, so that tests can write
// what the encoder never does. A second reading of the text: it does not use format/chart_table.cpp or chart_border.h.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "encoder/code/range_encoder.h"
#include "format/bits.h"
#include "format/bytes.h"

namespace gim::test {

struct RawChart {
    uint32_t columns = 2, rows = 2;
    uint32_t column = 0, row = 0;  // plus margin, as stored
    uint32_t path_count = 0;       // 0: as many as `paths` says
    // '-': a boundary, '<': a new open path, '0'..'9': the mate of the open path that many places back.
    std::string paths = "-";
};

struct RawTable {
    uint64_t chart_count = 0;  // 0: as many as there are
    uint64_t margin = 0;
    uint32_t box_bits = 4;
    std::vector<std::array<uint64_t, 2>> sizes;  // vertices and triangles, finest first
    std::vector<RawChart> charts;
};

// width, height: of the rectangle in the header.
inline std::vector<uint8_t> table_bytes(const RawTable& table, uint32_t width, uint32_t height) {
    std::vector<uint8_t> bytes;
    append_leb128(table.chart_count ? table.chart_count : table.charts.size(), &bytes);
    append_leb128(table.margin, &bytes);
    bytes.push_back(static_cast<uint8_t>(table.box_bits));
    for (const auto& size : table.sizes) {
        append_leb128(size[0], &bytes);
        append_leb128(size[1], &bytes);
    }
    BitWriter bits(&bytes);
    uint32_t open = 0;
    const auto margin = static_cast<uint32_t>(table.margin);
    for (const RawChart& chart : table.charts) {
        bits.write(chart.columns - 1, static_cast<int>(table.box_bits));
        bits.write(chart.rows - 1, static_cast<int>(table.box_bits));
        bits.write(chart.column, std::bit_width(width - 1 + margin));
        bits.write(chart.row, std::bit_width(height - 1 + margin));
        const auto count = chart.path_count ? chart.path_count : static_cast<uint32_t>(chart.paths.size());
        bits.write(0, std::bit_width(count) - 1);
        bits.write(count, std::bit_width(count));
        for (const char path : chart.paths) {
            if (path == '-') {
                bits.write(0, 2);
            } else if (path == '<') {
                bits.write(1, 2);
                ++open;
            } else {
                bits.write(1, 1);
                if (open > 0) bits.write(static_cast<uint32_t>(path - '0'), std::bit_width(open - 1));
                open -= open > 0;
            }
        }
    }
    return bytes;
}

// Writes walks and zippers, right or wrong ones.
class RawBorderWriter {
  public:
    explicit RawBorderWriter(RangeEncoder* coder) : coder_(*coder) {}

    // columns, rows: of the box; they set the width of the fields.
    void begin_chart(uint32_t columns, uint32_t rows, uint32_t column, uint32_t row) {
        coder_.code_raw(column, static_cast<uint32_t>(std::bit_width(columns - 1)));
        coder_.code_raw(row, static_cast<uint32_t>(std::bit_width(rows - 1)));
        turns_ = {};
        first_ = true;
        guide_.clear();
    }
    // At a finer level. coarse: columns and rows of the chart's border at the next coarser level, sample after sample.
    void begin_guided_chart(uint32_t column, uint32_t row, std::vector<std::array<int64_t, 2>> coarse) {
        guide_ = std::move(coarse);
        difference(start_, int64_t{column} - 2 * guide_[0][0]);
        difference(start_, int64_t{row} - 2 * guide_[0][1]);
        column_ = column;
        row_ = row;
        first_ = true;
        guide_begin_ = guide_end_ = 0;
    }
    // The next path, which has coarse_length steps at the coarser level. is_second: its mate came before it.
    void guided_length(uint32_t length, uint32_t coarse_length, bool is_second) {
        difference(length_[is_second ? 3 : 2], int64_t{length} - 2 * int64_t{coarse_length});
        guide_begin_ = guide_end_;
        guide_end_ += coarse_length;
        guide_at_ = guide_begin_;
    }
    void length(uint32_t length) { number(length_[0], length - 1); }
    void length_of_second(uint32_t length, uint32_t first_length) {
        const auto d = static_cast<int32_t>(length - first_length);
        number(length_[1], static_cast<uint32_t>(d > 0 ? 2 * d - 1 : -2 * d));
    }
    void number_of_second(uint32_t n) { number(length_[1], n); }
    // A direction of 11.3 per digit.
    void steps(const std::string& directions) {
        for (const char c : directions) {
            const auto direction = static_cast<uint32_t>(c - '0');
            if (first_) {
                coder_.code_raw(direction, 3);
            } else {
                const auto t = static_cast<int32_t>((direction - direction_ + 3) & 7) - 3;
                turn(guide_.empty() ? models_after(t) : guided_[guide_class()], t);
            }
            first_ = false;
            direction_ = direction;
            column_ += kStep[direction][0];
            row_ += kStep[direction][1];
        }
    }
    // A step of 11.3 per digit, including those that are not coded.
    void zipper(int64_t first, int64_t second, const std::string& steps) {
        const int64_t longer = first > second ? first : second;
        int64_t a = first, b = second;
        uint32_t last = 0;
        for (const char c : steps) {
            const auto step = static_cast<uint32_t>(c - '0');
            if (a > 0 && b > 0) {
                const int64_t lag = 2 * (a * second - b * first), size = lag < 0 ? -lag : lag;
                uint32_t phase = 0;
                if (size >= longer) phase = (lag > 0 ? 1u : 3u) + (size >= 3 * longer ? 1u : 0u);
                coder_.code_bit(zip_[0][5 * last + phase], step != 0);
                if (step != 0) coder_.code_bit(zip_[1][5 * last + phase], step == 2);
            }
            a -= step != 2;
            b -= step != 1;
            last = step;
        }
    }

  private:
    void number(std::array<BitModel, 25>& models, uint32_t n) {
        const auto width = static_cast<uint32_t>(std::bit_width(n + 1)) - 1;
        for (uint32_t w = 0; w < width; ++w) coder_.code_bit(models[w], 1);
        if (width == 25) return;  // no longer read
        coder_.code_bit(models[width], 0);
        if (width > 0) coder_.code_raw(n + 1 - (1u << width), width);
    }
    static constexpr std::array<std::array<int64_t, 2>, 8> kStep{
        {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

    void difference(std::array<BitModel, 25>& models, int64_t d) {
        number(models, static_cast<uint32_t>(d > 0 ? 2 * d - 1 : -2 * d));
    }
    std::array<int64_t, 2> to_guide(size_t k) const {
        const auto& p = guide_[k % guide_.size()];
        return {2 * p[0] - column_, 2 * p[1] - row_};
    }
    size_t guide_class() {
        const auto far = [&](size_t k) { return to_guide(k)[0] * to_guide(k)[0] + to_guide(k)[1] * to_guide(k)[1]; };
        while (guide_at_ < guide_end_ && far(guide_at_ + 1) <= far(guide_at_)) ++guide_at_;
        const auto v = to_guide(std::min<size_t>(guide_at_ + 1, guide_end_));
        const auto& d = kStep[direction_];
        const int64_t f = d[0] * v[0] + d[1] * v[1], s = d[0] * v[1] - d[1] * v[0], a = s < 0 ? -s : s;
        if (f == 0 && s == 0) return 11;
        const int k = 5 * a < f ? 0 : 3 * a < 2 * f ? 1 : 2 * a < 3 * f ? 2 : a < 5 * f ? 3 : a > -5 * f ? 4 : 5;
        return static_cast<size_t>(s < 0 ? 5 - k : 5 + k);
    }
    // Models by the turns before this one.
    std::array<BitModel, 4>& models_after(int32_t t) {
        const auto sign = [](int32_t x) { return x < 0 ? 0u : x == 0 ? 1u : 2u; };
        const uint32_t q = turns_[0] > 1 ? 4 : turns_[0] < -1 ? 3 : sign(turns_[0]);
        auto& models = turn_[(q * 3 + sign(turns_[1])) * 3 + sign(turns_[2])];
        turns_ = {t, turns_[0], turns_[1]};
        return models;
    }
    void turn(std::array<BitModel, 4>& models, int32_t t) {
        coder_.code_bit(models[0], t != 0);
        if (t == 0) return;
        coder_.code_bit(models[1], t < 0);
        const auto size = static_cast<uint32_t>(t < 0 ? -t : t);
        for (uint32_t k = 1; k < 3; ++k) {
            coder_.code_bit(models[1 + k], size > k);
            if (size <= k) break;
        }
    }

    RangeEncoder& coder_;
    std::array<std::array<BitModel, 4>, 45> turn_;
    std::array<std::array<BitModel, 4>, 12> guided_;
    std::array<std::array<BitModel, 25>, 4> length_;
    std::array<BitModel, 25> start_;
    std::array<std::array<BitModel, 15>, 2> zip_;
    std::array<int32_t, 3> turns_{};
    uint32_t direction_ = 0;
    bool first_ = true;
    std::vector<std::array<int64_t, 2>> guide_;  // empty at the coarsest level
    size_t guide_begin_ = 0, guide_end_ = 0, guide_at_ = 0;
    int64_t column_ = 0, row_ = 0;
};

}  // namespace gim::test
