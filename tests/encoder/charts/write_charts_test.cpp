#include "encoder/charts/write_charts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "encoder/code/assemble_file.h"
#include "encoder/code/decode_surface.h"
#include "encoder/code/file_units.h"
#include "gim/decoder.hpp"
#include "tests/encoder/charts/made_charts.h"
#include "tests/encoder/coding_parameters.h"

namespace gim {
namespace {

using namespace gim::test;
using Bytes = std::vector<uint8_t>;

CodingParameters lossless(uint32_t bits = 12) {
    CodingParameters p;
    p.bits = bits;
    return p;
}

Bytes written(const ChartLevels& images, const CodingParameters& parameters) {
    auto writer = charts_writer(images, parameters);
    EXPECT_TRUE(writer.ok()) << writer.error().message;
    return writer.value().write(parameters.quantizer);
}

// Level 0 as the rectangle.
std::vector<float> rectangle_of(const Bytes& bytes, gim_info* info) {
    Decoder decoder;
    DecoderLevel level;
    EXPECT_EQ(decoder.open(bytes), GIM_OK);
    EXPECT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    *info = decoder.info();
    std::vector<float> grid(size_t{level.width} * level.height * 3);
    EXPECT_EQ(decoder.grid(level, {grid, {}, {}, {}}), GIM_OK);
    return grid;
}

std::vector<std::pair<std::string, ChartLevels>> all_images() {
    return {{"equal disks", pillow(7, 7, 2)},
            {"unequal disks", pillow(9, 6, 2)},
            {"torus", torus_of_one_chart(17, 3)},
            {"sheet", open_sheet(2)},
            {"ladder", made_images(2, 30, {rectangle_chart(2, 30, 2)}, {kNone, kNone}, 1)}};
}

TEST(WriteCharts, LosslessSamplesAreTheQuantizedOnesAndTheRestIsNotANumber) {
    for (const auto& [name, images] : all_images()) {
        for (const uint32_t bits : {8u, 12u, 20u}) {
            gim_info info;
            const Bytes bytes = written(images, lossless(bits));
            const std::vector<float> grid = rectangle_of(bytes, &info);
            EXPECT_EQ(info.bits, bits);
            Units header;
            header.bits = info.bits;
            header.step = info.step;
            for (size_t k = 0; k < 3; ++k) header.origin[k] = static_cast<float>(info.origin[k]);
            std::vector<uint8_t> seen(grid.size() / 3, 0);
            for (size_t c = 0; c < images.charts.size(); ++c) {
                const ChartBox& box = images.charts[c];
                const std::vector<int32_t> units = to_units<int32_t>(images.positions[c], header);
                for (uint32_t i = 0; i < images.defined[c].size(); ++i) {
                    if (!images.defined[c][i]) continue;
                    const auto column = static_cast<uint32_t>(box.atlas_column) + i % box.columns,
                               row = static_cast<uint32_t>(box.atlas_row) + i / box.columns;
                    const uint32_t at = row * images.image.mask.width + column;
                    ASSERT_EQ(seen[at]++, 0) << name << ": charts upon each other";
                    for (size_t k = 0; k < 3; ++k)
                        ASSERT_EQ(grid[size_t{at} * 3 + k],
                                  header.origin[k] + info.step * static_cast<float>(units[size_t{i} * 3 + k]))
                            << name << " " << bits << " bits";
                }
            }
            for (size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(std::isnan(grid[i * 3]), seen[i] == 0) << name;
        }
    }
}

TEST(WriteCharts, EveryLevelHasTheClaimedSizeAndTheTopologyOfTheFirst) {
    for (const auto& [name, images] : all_images()) {
        for (const CodingParameters& parameters : {lossless(), lossy(2), lossy(100)}) {
            const Bytes bytes = written(images, parameters);
            const auto coarsest = coarsest_level(bytes);
            ASSERT_TRUE(coarsest.ok()) << name;
            ASSERT_EQ(coarsest.value() + 1, images.levels.size()) << name;
            TopologySummary first;
            for (uint32_t level = 0; level < images.levels.size(); ++level) {
                const auto surface = decode_surface(bytes, level);
                ASSERT_TRUE(surface.ok()) << name << ": " << surface.error().message;
                const Mesh& mesh = surface.value();
                EXPECT_EQ(mesh.positions.size(), images.levels[level].size.vertices) << name;
                EXPECT_EQ(mesh.triangles.size(), images.levels[level].size.triangles) << name;
                const TopologySummary t = analyse_topology(mesh.triangles, mesh.positions.size()).summary;
                if (level == 0) first = t;
                EXPECT_TRUE(same_topology(first, t)) << name << " level " << level;
            }
        }
    }
}

TEST(WriteCharts, FinerQuantizersGiveMoreBytesAndSmallerErrors) {
    const ChartLevels images = pillow(9, 6, 2);
    const auto writer = charts_writer(images, lossy(1));
    ASSERT_TRUE(writer.ok());
    gim_info exact_info, info;
    const std::vector<float> exact = rectangle_of(written(images, lossless(20)), &exact_info);
    double last_error = 0;
    size_t last_size = std::numeric_limits<size_t>::max();
    for (const double quantizer : {1.0, 8.0, 64.0}) {
        const Bytes bytes = writer.value().write(quantizer);
        const std::vector<float> grid = rectangle_of(bytes, &info);
        double error = 0;
        for (size_t i = 0; i < grid.size(); ++i) {
            ASSERT_EQ(std::isnan(grid[i]), std::isnan(exact[i]));
            if (!std::isnan(grid[i])) error = std::max<double>(error, std::abs(grid[i] - exact[i]));
        }
        EXPECT_GT(error, last_error);
        EXPECT_LT(error, 4 * quantizer * static_cast<double>(info.step));
        EXPECT_LT(bytes.size(), last_size);
        last_error = error;
        last_size = bytes.size();
    }
    EXPECT_EQ(writer.value().write(8), writer.value().write(8));
}

TEST(WriteCharts, WhatTheFormatCannotTakeIsRefusedWithWords) {
    const auto refused = [](const std::function<void(ChartLevels&, CodingParameters&)>& change,
                            const std::string& word) {
        ChartLevels images = open_sheet(2);
        CodingParameters parameters = lossless();
        change(images, parameters);
        const auto writer = charts_writer(images, parameters);
        return !writer.ok() && writer.error().message.find(word) != std::string::npos;
    };
    EXPECT_FALSE(refused([](ChartLevels&, CodingParameters&) {}, ""));
    EXPECT_TRUE(refused([](ChartLevels& i, CodingParameters&) { i = {}; }, "no chart"));
    EXPECT_TRUE(refused([](ChartLevels& i, CodingParameters&) { i.levels.clear(); }, "no chart"));
    EXPECT_TRUE(refused([](ChartLevels&, CodingParameters& p) { p.bits = 7; }, "bits 7"));
    EXPECT_TRUE(refused([](ChartLevels&, CodingParameters& p) { p.bits = 21; }, "bits 21"));
    EXPECT_TRUE(refused([](ChartLevels& i, CodingParameters&) { i.charts.resize(kMaxCharts + 1); }, "8193 charts"));
    EXPECT_TRUE(refused([](ChartLevels& i, CodingParameters&) { i.mates.resize(kMaxChartPaths + 1); }, "fewer charts"));
    EXPECT_TRUE(refused([](ChartLevels& i, CodingParameters&) { i.image.mask.width = kMaxAtlasSide + 1; }, "too long"));
    EXPECT_TRUE(refused([](ChartLevels& i, CodingParameters&) { i.charts[1].rows = kMaxChartSide + 1; }, "chart 1"));
    EXPECT_TRUE(refused([](ChartLevels& i, CodingParameters&) { i.positions[1][3].x() = std::nan(""); }, "chart 1"));
    EXPECT_TRUE(refused([](ChartLevels& i, CodingParameters&) { i.positions[0][3].z() = 1e31; }, "chart 0"));
}

TEST(WriteCharts, TextAndMeasuredLevelsAreCarried) {
    CodingParameters parameters = lossy(4);
    parameters.text = "charts";
    parameters.bounds = true;
    const std::vector<LevelError> errors = {{1.5, 7}, {3, 80}};
    const Bytes bytes = set_level_errors(written(open_sheet(2), parameters), errors);
    gim_info info;
    ASSERT_EQ(gim_read_info(bytes.data(), bytes.size(), nullptr, &info), GIM_OK);
    for (size_t level = 0; level < 2; ++level) {
        EXPECT_GE(info.level_rms_error[level], errors[level].rms);
        EXPECT_LE(info.level_rms_error[level], 1.08 * errors[level].rms);
        EXPECT_GE(info.level_max_error[level], errors[level].max);
        EXPECT_LE(info.level_max_error[level], 1.08 * errors[level].max);
    }
    uint64_t size = 0;
    EXPECT_EQ(gim_read_text(&info, bytes.data(), bytes.size(), nullptr, 0, &size, nullptr, 0), GIM_OK);
    EXPECT_EQ(size, 6u);
    EXPECT_TRUE(decode_surface(bytes, 1).ok());
}

}  // namespace
}  // namespace gim
