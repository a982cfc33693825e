#include "encoder/charts/close_chart_seams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "encoder/charts/write_charts.h"
#include "encoder/code/code_bands.h"
#include "format/chart_ramp.h"
#include "gim/decoder.hpp"
#include "tests/encoder/charts/corpus_charts.h"

namespace gim {
namespace {

ChartLevels charts_of(const char* name) { return test::corpus_charts(name, 2000); }

// A lossy file, and the bands that it holds.
struct LossyCharts {
    std::vector<uint8_t> bytes;
    std::vector<Pyramid<int32_t>> bands;
    Units units;
};

LossyCharts written(const ChartLevels& charts, double quantizer) {
    LossyCharts result;
    CodingParameters parameters;
    parameters.lossless = false;
    parameters.quantizer = quantizer;
    parameters.repair = [&](size_t first, std::span<Pyramid<int32_t>> bands, const Units& units) {
        EXPECT_EQ(first, 0u);
        result.bands.assign(bands.begin(), bands.end());
        result.units = units;
    };
    result.bytes = charts_writer(charts, parameters).value().write(quantizer);
    return result;
}

// Samples of the whole image in units, as a decoder has them before it closes the seams. Undefined samples are zero.
std::vector<float> open_image(const ChartLevels& charts, const LossyCharts& lossy) {
    std::vector<float> image(3 * charts.sample_count(), 0.0f);
    for (size_t c = 0; c < charts.charts.size(); ++c) {
        const ChartBox& box = charts.charts[c];
        const std::vector<float> decoded = decode_bands(lossy.bands[c], detail_coding_of(lossy.units)).back();
        for (uint32_t i = 0; i < box.columns * box.rows; ++i) {
            if (!charts.defined[c][i]) continue;
            const auto row = static_cast<size_t>(box.atlas_row + static_cast<int32_t>(i / box.columns)),
                       column = static_cast<size_t>(box.atlas_column + static_cast<int32_t>(i % box.columns));
            for (size_t k = 0; k < 3; ++k)
                image[3 * (row * charts.image.width() + column) + k] =
                    decoded[3 * i + k] + static_cast<float>(1 << (lossy.units.bits - 1));
        }
    }
    return image;
}

// The same samples as the public decoder gives them. Undefined ones are not numbers.
std::vector<float> decoded_image(const LossyCharts& lossy) {
    Decoder decoder;
    DecoderLevel level;
    EXPECT_EQ(decoder.open(lossy.bytes), GIM_OK);
    EXPECT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    std::vector<float> image(size_t{level.width} * level.height * 3);
    EXPECT_EQ(decoder.grid(level, {image, {}, {}, {}}), GIM_OK);
    for (size_t i = 0; i < image.size(); ++i)
        image[i] =
            static_cast<float>((double{image[i]} - double{lossy.units.origin[i % 3]}) / double{lossy.units.step});
    return image;
}

float largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
    float most = 0;
    for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

TEST(CloseChartSeams, DoesWhatADecoderDoes) {
    for (const char* name : {"torus-576", "disk-180"}) {
        const ChartLevels charts = charts_of(name);
        for (const double quantizer : {2.0, 16.0, 80.0}) {
            const LossyCharts lossy = written(charts, quantizer);
            const std::vector<float> open = open_image(charts, lossy), decoded = decoded_image(lossy);
            std::vector<float> closed = open;
            close_chart_seams(charts, closed);
            ASSERT_EQ(closed.size(), decoded.size());
            for (size_t i = 0; i < closed.size(); ++i) {
                ASSERT_EQ(std::isnan(decoded[i]), !charts.image.gluing.is_defined(static_cast<uint32_t>(i / 3)));
                // A decoder rounds values around 2^(bits-1), not 0.
                if (std::isnan(decoded[i])) continue;
                ASSERT_NEAR(closed[i], decoded[i], 0.02f) << name << " " << quantizer;
            }
            EXPECT_GT(largest_difference(open, closed), 0.3 * quantizer) << name;
        }
    }
}

TEST(CloseChartSeams, GluedSamplesBecomeEqualAndDeepSamplesStay) {
    const ChartLevels charts = charts_of("torus-576");
    const GridGluing& gluing = charts.image.gluing;
    const std::vector<float> open = open_image(charts, written(charts, 20));
    std::vector<float> closed = open;
    close_chart_seams(charts, closed);
    ASSERT_GT(gluing.shared.size(), 50u);
    for (const auto& members : gluing.shared) {
        for (size_t k = 0; k < 3; ++k) {
            float mean = 0;
            for (const uint32_t v : members) mean += open[3 * v + k] / static_cast<float>(members.size());
            for (const uint32_t v : members) {
                EXPECT_EQ(closed[3 * v + k], closed[3 * members[0] + k]);
                EXPECT_NEAR(closed[3 * v + k], mean, 0.01f);
            }
        }
    }
    size_t stayed = 0;
    for (size_t c = 0; c < charts.charts.size(); ++c) {
        const ChartBox& box = charts.charts[c];
        const auto width = static_cast<int32_t>(chart_diffusion_width(box.columns, box.rows));
        // A sample is deep if all samples of the square around it are defined.
        for (int32_t row = width + 1; row + width + 1 < static_cast<int32_t>(box.rows); ++row) {
            for (int32_t column = width + 1; column + width + 1 < static_cast<int32_t>(box.columns); ++column) {
                bool is_deep = true;
                for (int32_t r = row - width - 1; r <= row + width + 1; ++r) {
                    for (int32_t x = column - width - 1; x <= column + width + 1; ++x)
                        is_deep &=
                            charts.defined[c][static_cast<size_t>(r) * box.columns + static_cast<size_t>(x)] != 0;
                }
                if (!is_deep) continue;
                const size_t at = static_cast<size_t>(box.atlas_row + row) * charts.image.width() +
                                  static_cast<size_t>(box.atlas_column + column);
                for (size_t k = 0; k < 3; ++k) EXPECT_EQ(closed[3 * at + k], open[3 * at + k]);
                ++stayed;
            }
        }
    }
    EXPECT_GT(stayed, 50u);
}

TEST(CloseChartSeams, ClosedSeamsStayAsTheyAre) {
    const ChartLevels charts = charts_of("torus-576");
    std::vector<float> closed = open_image(charts, written(charts, 20));
    close_chart_seams(charts, closed);
    std::vector<float> again = closed;
    close_chart_seams(charts, again);
    EXPECT_EQ(again, closed);
}

}  // namespace
}  // namespace gim
