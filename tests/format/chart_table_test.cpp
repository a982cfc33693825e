#include "format/chart_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/format/random_sideband.h"
#include "tests/format/raw_chart_table.h"

namespace gim {
namespace {

using test::Random;
using test::RawChart;
using test::RawTable;
using Bytes = std::vector<uint8_t>;

Header rectangle(uint32_t width, uint32_t height, uint32_t level_count) {
    Header header;
    header.layout = FileLayout::kCharts;
    header.width = width;
    header.height = height;
    header.level_count = level_count;
    return header;
}

struct Read {
    Status status = Status::kOk;
    ChartTable table;
};
Read read(Bytes bytes, const Header& header, const ContainerLimits& limits = {}) {
    bytes.shrink_to_fit();  // so that sanitizers notice one byte too many
    Read result;
    const auto reader = std::make_unique<ChartTableReader>();
    result.status = reader->open(bytes, header, limits);
    std::vector<uint32_t> mates(kMaxChartPaths, 12345);
    for (uint32_t c = 0; result.status == Status::kOk && c < reader->chart_count(); ++c) {
        ChartBox chart;
        result.status = reader->next(&chart, mates.data());
        result.table.charts.push_back(chart);
    }
    if (result.status == Status::kOk) result.status = reader->finish();
    for (uint32_t l = 0; l < header.level_count; ++l) result.table.levels.push_back(reader->level(l));
    mates.resize(reader->path_count());
    result.table.mates = mates;
    return result;
}

void expect_same(const ChartTable& a, const ChartTable& b) {
    ASSERT_EQ(a.charts.size(), b.charts.size());
    for (size_t c = 0; c < a.charts.size(); ++c) {
        EXPECT_EQ(a.charts[c].columns, b.charts[c].columns);
        EXPECT_EQ(a.charts[c].rows, b.charts[c].rows);
        EXPECT_EQ(a.charts[c].atlas_column, b.charts[c].atlas_column);
        EXPECT_EQ(a.charts[c].atlas_row, b.charts[c].atlas_row);
        EXPECT_EQ(a.charts[c].path_count, b.charts[c].path_count);
    }
    EXPECT_EQ(a.mates, b.mates);
    ASSERT_EQ(a.levels.size(), b.levels.size());
    for (size_t l = 0; l < a.levels.size(); ++l) {
        EXPECT_EQ(a.levels[l].vertices, b.levels[l].vertices);
        EXPECT_EQ(a.levels[l].triangles, b.levels[l].triangles);
    }
}

ChartTable random_table(Random& random, const Header& header) {
    ChartTable table;
    const uint32_t charts = 1 + random.below(12);
    const uint32_t most_side = 3 + random.below(random.below(2) ? 30 : 3000);
    const auto least = (1u << (header.level_count - 1)) + 1;
    for (uint32_t c = 0; c < charts; ++c) {
        ChartBox chart;
        chart.columns = least + random.below(most_side);
        chart.rows = least + random.below(most_side);
        chart.atlas_column = static_cast<int32_t>(random.below(header.width + 40)) - 40;
        chart.atlas_row = static_cast<int32_t>(random.below(header.height + 40)) - 40;
        chart.path_count = 1 + random.below(6);
        for (uint32_t k = 0; k < chart.path_count; ++k) table.mates.push_back(kNoMate);
        table.charts.push_back(chart);
    }
    // Some paths are mates, in any order.
    std::vector<uint32_t> order(table.mates.size());
    for (uint32_t p = 0; p < order.size(); ++p) order[p] = p;
    for (uint32_t p = static_cast<uint32_t>(order.size()); p > 1; --p) std::swap(order[p - 1], order[random.below(p)]);
    for (size_t p = 0; p + 1 < order.size(); p += 2) {
        if (random.below(4) == 0) continue;
        table.mates[order[p]] = order[p + 1];
        table.mates[order[p + 1]] = order[p];
    }
    for (uint32_t l = 0; l < header.level_count; ++l)
        table.levels.push_back({3 + random.below(1000000), 1 + random.below(1000000)});
    return table;
}

// Two charts of 5 x 4 and 3 x 9 in a rectangle of 16 x 9; the mates of the first one's paths follow in turned order.
RawTable two_charts() {
    RawTable table;
    table.margin = 2;
    table.sizes = {{20, 24}, {6, 8}};
    table.charts = {{5, 4, 2, 2, 0, "<<-"}, {3, 9, 12, 0, 0, "00"}};
    return table;
}
const Header kTwo = rectangle(16, 9, 2);

TEST(ChartTable, HandWrittenBytesAreRead) {
    // 2 charts, margin 2, 4 bits a side, 20 vertices, 24 triangles; 6, 8. Then column 0..17 in 5 bits, row 0..10 in 4:
    // 0100 0011 00010 0010 | 011 01 01 00 | 0010 1000 01100 0000 | 010 10 1 | 0000000
    // The second chart's first path has two open ones to choose from; bit 0 means the one opened last. Its second path
    // has one, which takes no bit.
    const Bytes bytes = {2,          2,          4,          20,         24,         6,          8,
                         0b01000011, 0b00010001, 0b00110101, 0b00001010, 0b00011000, 0b00001010, 0b10000000};
    const Read back = read(bytes, kTwo);
    ASSERT_EQ(back.status, Status::kOk);
    ASSERT_EQ(back.table.charts.size(), 2u);
    EXPECT_EQ(back.table.charts[0].columns, 5u);
    EXPECT_EQ(back.table.charts[0].rows, 4u);
    EXPECT_EQ(back.table.charts[0].atlas_column, 0);
    EXPECT_EQ(back.table.charts[0].atlas_row, 0);
    EXPECT_EQ(back.table.charts[1].columns, 3u);
    EXPECT_EQ(back.table.charts[1].rows, 9u);
    EXPECT_EQ(back.table.charts[1].atlas_column, 10);
    EXPECT_EQ(back.table.charts[1].atlas_row, -2);
    EXPECT_EQ(back.table.mates, (std::vector<uint32_t>{4, 3, kNoMate, 1, 0}));
    EXPECT_EQ(back.table.levels[1].triangles, 8u);
    EXPECT_EQ(test::table_bytes(two_charts(), 16, 9), bytes);
}

TEST(ChartTable, RandomTablesComeBack) {
    Random random(3);
    for (int round = 0; round < 500; ++round) {
        const Header header = rectangle(2 + random.below(5000), 2 + random.below(5000), 1 + random.below(4));
        const ChartTable table = random_table(random, header);
        const Bytes bytes = serialize_chart_table(table, header);
        const Read back = read(bytes, header);
        ASSERT_EQ(back.status, Status::kOk) << round;
        expect_same(back.table, table);
    }
}

TEST(ChartTable, EveryTruncationAndEveryFurtherByteIsRefused) {
    Random random(4);
    for (int round = 0; round < 40; ++round) {
        const Header header = rectangle(300, 200, 1 + random.below(3));
        Bytes bytes = serialize_chart_table(random_table(random, header), header);
        for (size_t n = 0; n < bytes.size(); ++n)
            ASSERT_EQ(read({bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(n)}, header).status,
                      Status::kMalformed);
        bytes.push_back(0);
        EXPECT_EQ(read(bytes, header).status, Status::kMalformed);
    }
}

TEST(ChartTable, WhatIsReadFromDamagedBytesStaysInBounds) {
    Random random(5);
    for (int round = 0; round < 100; ++round) {
        const Header header = rectangle(300, 200, 1 + random.below(3));
        const Bytes whole = serialize_chart_table(random_table(random, header), header);
        for (size_t bit = 0; bit < whole.size() * 8; ++bit) {
            Bytes bytes = whole;
            bytes[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
            const Read back = read(bytes, header);
            if (back.status != Status::kOk) continue;
            uint32_t paths = 0;
            for (const ChartBox& chart : back.table.charts) {
                EXPECT_GE(std::min(chart.columns, chart.rows), 2u);
                EXPECT_LE(std::max(chart.columns, chart.rows), kMaxChartSide);
                EXPECT_LT(chart.atlas_column, 300);
                EXPECT_LT(chart.atlas_row, 200);
                EXPECT_GE(chart.path_count, 1u);
                paths += chart.path_count;
            }
            ASSERT_EQ(paths, back.table.mates.size());
            for (uint32_t p = 0; p < paths; ++p) {
                const uint32_t mate = back.table.mates[p];
                if (mate == kNoMate) continue;
                ASSERT_LT(mate, paths);
                EXPECT_NE(mate, p);
                EXPECT_EQ(back.table.mates[mate], p);
            }
        }
    }
}

TEST(ChartTable, FieldsOutOfRangeAreMalformed) {
    const auto status = [](const auto& change, const Header& header = kTwo) {
        RawTable table = two_charts();
        change(table);
        return read(test::table_bytes(table, header.width, header.height), header).status;
    };
    EXPECT_EQ(status([](RawTable&) {}), Status::kOk);
    EXPECT_EQ(status([](RawTable& t) { t.charts.clear(); }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.chart_count = kMaxCharts + 1; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.chart_count = 3; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.chart_count = 1; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.margin = 4096; }), Status::kOk);
    EXPECT_EQ(status([](RawTable& t) { t.margin = 4097; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.box_bits = 0; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.box_bits = 15; }), Status::kOk);
    EXPECT_EQ(status([](RawTable& t) { t.box_bits = 16; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.sizes[0][0] = 2; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.sizes[1][1] = 0; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.sizes[1][0] = uint64_t{1} << 40; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.sizes[1][1] = uint64_t{1} << 40; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.charts[0].columns = 1; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.charts[1].rows = 1; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.charts[0].rows = 2; }), Status::kMalformed);  // cannot be halved
    EXPECT_EQ(status([](RawTable& t) { t.charts[0].column = 17; }), Status::kOk);
    EXPECT_EQ(status([](RawTable& t) { t.charts[0].column = 18; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.charts[1].row = 11; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.charts[0].paths = "<<<"; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.charts[0].paths = "0"; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.charts = {{5, 4, 0, 0, 0, "<<<3--"}}; }), Status::kMalformed);  // 0..2
    EXPECT_EQ(status([](RawTable& t) { t.charts[0].path_count = 16385; }), Status::kMalformed);
    EXPECT_EQ(status([](RawTable& t) { t.charts[0].path_count = (1u << 24) - 1; }), Status::kMalformed);
    // Bits in the padding.
    Bytes bytes = test::table_bytes(two_charts(), 16, 9);
    bytes.back() |= 1;
    EXPECT_EQ(read(bytes, kTwo).status, Status::kMalformed);
    // 24 zeros before a number of paths.
    bytes = {1, 0, 4, 20, 24, 0x44, 0x00, 0, 0, 0, 1, 0, 0, 0, 0};
    EXPECT_EQ(read(bytes, rectangle(2, 2, 1)).status, Status::kMalformed);
}

TEST(ChartTable, StepsAreHalvingsThatLeaveTwoSamplesEachWay) {
    const auto steps = [](uint32_t columns, uint32_t rows) {
        ChartBox box;
        box.columns = columns;
        box.rows = rows;
        return box.steps();
    };
    EXPECT_EQ(steps(2, 2), 0u);
    EXPECT_EQ(steps(2, 3000), 0u);
    EXPECT_EQ(steps(3, 3), 1u);
    EXPECT_EQ(steps(4, 3), 1u);
    EXPECT_EQ(steps(4, 5), 1u);
    EXPECT_EQ(steps(5, 5), 2u);
    EXPECT_EQ(steps(9, 10), 3u);
    EXPECT_EQ(steps(16385, 16385), 14u);
    EXPECT_EQ(steps(kMaxChartSide, kMaxChartSide), 14u);
    // As many levels as there are steps, plus the base.
    RawTable table;
    table.sizes = {{3, 1}, {3, 1}, {3, 1}};
    table.charts = {{5, 5, 0, 0, 0, "-"}};
    EXPECT_EQ(read(test::table_bytes(table, 16, 9), rectangle(16, 9, 3)).status, Status::kOk);
    table.charts[0].rows = 4;
    EXPECT_EQ(read(test::table_bytes(table, 16, 9), rectangle(16, 9, 3)).status, Status::kMalformed);
}

TEST(ChartTable, ManyPathsAndChartsAreTakenAndOneMoreIsNot) {
    const Header header = rectangle(100, 100, 1);
    RawTable table;
    table.sizes = {{3, 1}};
    // All open paths first, then their mates.
    table.charts = {{2, 2, 0, 0, 0, std::string(kMaxChartPaths / 2, '<')},
                    {2, 2, 0, 0, 0, std::string(kMaxChartPaths / 2, '0')}};
    EXPECT_EQ(read(test::table_bytes(table, 100, 100), header).status, Status::kOk);
    table.charts[0].paths += "<";
    table.charts[1].paths.pop_back();
    EXPECT_EQ(read(test::table_bytes(table, 100, 100), header).status, Status::kMalformed);
    table.charts[0].paths.pop_back();
    table.charts[1].paths += "0-";
    EXPECT_EQ(read(test::table_bytes(table, 100, 100), header).status, Status::kMalformed);
    table.charts.assign(kMaxCharts, {2, 2, 0, 0, 0, "-"});
    EXPECT_EQ(read(test::table_bytes(table, 100, 100), header).status, Status::kOk);
}

TEST(ChartTable, SamplesOfAllBoxesCountAgainstTheLimit) {
    RawTable table;
    table.sizes = {{3, 1}};
    table.charts = {{10, 12, 0, 0, 0, "-"}, {6, 5, 0, 0, 0, "-"}};
    const Bytes bytes = test::table_bytes(table, 16, 9);
    ContainerLimits limits;
    limits.max_samples = 150;
    EXPECT_EQ(read(bytes, rectangle(16, 9, 1), limits).status, Status::kOk);
    limits.max_samples = 149;
    EXPECT_EQ(read(bytes, rectangle(16, 9, 1), limits).status, Status::kLimitExceeded);
}

}  // namespace
}  // namespace gim
