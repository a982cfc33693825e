#include "encoder/charts/chart_ramps.h"

#include "format/chart_ramp.h"
#include "format/close_seams.h"

namespace gim {

ChartRamps::ChartRamps(const ChartLevels& charts) : charts_(charts) {
    for (size_t c = 0; c < charts.charts.size(); ++c) add_chart(c);
}

void ChartRamps::add_chart(size_t chart) {
    const ChartBox& box = charts_.charts[chart];
    const std::vector<uint32_t>& border = charts_.levels[0].loops[chart];
    const size_t count = size_t{box.columns} * box.rows;
    std::vector<uint8_t> depth(count);
    for (size_t i = 0; i < count; ++i) depth[i] = charts_.defined[chart][i] ? kInside : kUndefined;
    for (const uint32_t sample : border) depth[sample] = kOnBorder;
    // Nothing is to be corrected: this only finds the layers, and the order of their samples.
    std::vector<float> corrections(3 * count), samples(3 * count);
    std::vector<uint32_t> queue(count, kNone);
    spread_corrections({box.columns, box.rows, depth.data(), corrections.data(), samples.data()}, border, queue.data());

    const uint32_t width = chart_diffusion_width(box.columns, box.rows);
    const auto in_image = [&](uint32_t i) {
        const auto row = box.atlas_row + static_cast<int64_t>(i / box.columns);
        return static_cast<uint32_t>(row * charts_.image.width() + box.atlas_column + i % box.columns);
    };
    for (size_t q = border.size(); q < count && queue[q] != kNone; ++q) {
        const uint32_t i = queue[q];
        const auto before = neighbours_.size();
        for (const uint32_t row : {i - box.columns, i, i + box.columns}) {
            for (const uint32_t j : {row - 1, row, row + 1}) {
                if (depth[j] + 1u == depth[i]) neighbours_.push_back(in_image(j));
            }
        }
        const auto found = static_cast<float>(neighbours_.size() - before);
        inner_.push_back(
            {in_image(i), correction_decay(depth[i], width) / found, static_cast<uint32_t>(neighbours_.size())});
    }
}

void ChartRamps::transpose(std::vector<float>& image) const {
    std::vector<float> corrections(image.size());
    for (size_t n = inner_.size(); n-- > 0;) {
        const Inner& inner = inner_[n];
        for (size_t k = 0; k < 3; ++k) {
            float& own = corrections[3 * size_t{inner.sample} + k];
            own += image[3 * size_t{inner.sample} + k];
            for (uint32_t j = n == 0 ? 0 : inner_[n - 1].neighbours; j < inner.neighbours; ++j)
                corrections[3 * size_t{neighbours_[j]} + k] += inner.weight * own;
        }
    }
    // On a seam, a sample becomes the mean, and its correction is the mean without the sample.
    for (const auto& members : charts_.image.gluing.shared) {
        for (size_t k = 0; k < 3; ++k) {
            float sum = 0;
            for (const uint32_t v : members) sum += image[3 * size_t{v} + k] + corrections[3 * size_t{v} + k];
            const float mean = sum / static_cast<float>(members.size());
            for (const uint32_t v : members) image[3 * size_t{v} + k] = mean - corrections[3 * size_t{v} + k];
        }
    }
}

}  // namespace gim
