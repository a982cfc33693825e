#include "encoder/charts/close_chart_seams.h"

#include <cstdint>

#include "format/chart_ramp.h"

namespace gim {

namespace {

// Moves each class of samples to its mean. Returns what was added.
std::vector<float> average_classes(const GridGluing& gluing, std::vector<float>& image) {
    std::vector<float> corrections(image.size(), 0.0f);
    for (const auto& members : gluing.shared) {
        for (size_t k = 0; k < 3; ++k) {
            const float first = image[3 * size_t{members[0]} + k];
            float sum = 0;
            for (const uint32_t v : members) sum += image[3 * size_t{v} + k] - first;
            const float mean = first + sum / static_cast<float>(members.size());
            for (const uint32_t v : members) {
                corrections[3 * size_t{v} + k] = mean - image[3 * size_t{v} + k];
                image[3 * size_t{v} + k] = mean;
            }
        }
    }
    return corrections;
}

}  // namespace

void close_chart_seams(const ChartLevels& charts, std::vector<float>& image) {
    const std::vector<float> at_seams = average_classes(charts.image.gluing, image);
    std::vector<float> corrections, samples;
    std::vector<uint8_t> depth;
    std::vector<uint32_t> queue;
    for (size_t c = 0; c < charts.charts.size(); ++c) {
        const ChartBox& box = charts.charts[c];
        const size_t count = size_t{box.columns} * box.rows;
        corrections.assign(3 * count, 0.0f);
        samples.assign(3 * count, 0.0f);
        depth.assign(count, kUndefined);
        queue.resize(count);
        // Copies the chart from the image, or back.
        const auto for_each_defined = [&](const auto& body) {
            for (size_t i = 0; i < count; ++i) {
                if (!charts.defined[c][i]) continue;
                const auto row = box.atlas_row + static_cast<int64_t>(i / box.columns);
                const auto column = box.atlas_column + static_cast<int64_t>(i % box.columns);
                body(3 * i, 3 * static_cast<size_t>(row * charts.image.width() + column));
            }
        };
        for_each_defined([&](size_t in_box, size_t in_image) {
            depth[in_box / 3] = kInside;
            for (size_t k = 0; k < 3; ++k) {
                samples[in_box + k] = image[in_image + k];
                corrections[in_box + k] = at_seams[in_image + k];
            }
        });
        for (const uint32_t sample : charts.levels[0].loops[c]) depth[sample] = kOnBorder;
        spread_corrections({box.columns, box.rows, depth.data(), corrections.data(), samples.data()},
                           charts.levels[0].loops[c], queue.data());
        for_each_defined([&](size_t in_box, size_t in_image) {
            for (size_t k = 0; k < 3; ++k) image[in_image + k] = samples[in_box + k];
        });
    }
}

}  // namespace gim
