#include "encoder/code/detail_response.h"

#include <algorithm>
#include <cmath>

#include "encoder/code/wavelet_analysis.h"
#include "format/seam.h"

namespace gim {

namespace {

constexpr float kLeast = 0.02f;      // of the largest weight
constexpr uint32_t kMargin = 5;      // details nearer to an end of the band than this have functions of their own
constexpr uint32_t kSmallLows = 17;  // low samples per side of the small image that a function is computed on

// The side of the small image, at full resolution. Its far end is split as that of the large image.
uint32_t small_side(uint32_t side, uint32_t depth) {
    return std::min(side, ((kSmallLows - 1) << depth) + (side - 1) % (1u << depth) + 1);
}

// The place in a small band that is as near to an end as the place in the large band.
uint32_t small_place(uint32_t place, uint32_t count, uint32_t small_count) {
    if (count == small_count || place < kMargin) return place;
    if (count - 1 - place < kMargin) return small_count - (count - place);
    return small_count / 2;
}

std::vector<float>& band_of(AnalysisLevel<float>& level, Orientation orientation) {
    return orientation == Orientation::kHorizontal ? level.horizontal
           : orientation == Orientation::kVertical ? level.vertical
                                                   : level.diagonal;
}

}  // namespace

ResponseBlock DetailResponses::at(uint32_t depth, Orientation orientation, uint32_t row, uint32_t column) {
    const uint32_t columns = small_side(columns_, depth), rows = small_side(rows_, depth);
    const auto count = [&](uint32_t side, bool is_high) {
        const uint32_t at_depth = halved(side, depth - 1);
        return is_high ? high_count(at_depth) : low_count(at_depth);
    };
    const bool high_row = orientation != Orientation::kHorizontal, high_column = orientation != Orientation::kVertical;
    const Key key{depth, static_cast<uint32_t>(orientation),
                  small_place(row, count(rows_, high_row), count(rows, high_row)),
                  small_place(column, count(columns_, high_column), count(columns, high_column))};
    const std::lock_guard lock(*guards_known_);
    auto found = known_.find(key);
    if (found == known_.end()) found = known_.emplace(key, compute(key, columns, rows)).first;
    const Kept& kept = found->second;
    return {static_cast<uint32_t>(static_cast<int64_t>(row << depth) + kept.row),
            static_cast<uint32_t>(static_cast<int64_t>(column << depth) + kept.column), kept.rows, kept.columns,
            kept.weights.data()};
}

DetailResponses::Kept DetailResponses::compute(const Key& key, uint32_t columns, uint32_t rows) const {
    // The bands of the small image, all zero but for the detail.
    Pyramid<float> pyramid = zero_pyramid(columns, rows, key.depth);
    const auto orientation = static_cast<Orientation>(key.orientation);
    const uint32_t band_columns =
        orientation == Orientation::kVertical ? low_count(pyramid.columns_at(1)) : high_count(pyramid.columns_at(1));
    band_of(pyramid.levels[0], orientation)[3 * (size_t{key.row} * band_columns + key.column)] = 1;
    const SeamTable open_square{};
    const std::vector<float> image = restore<Irreversible97>(pyramid, has_rim_ ? &open_square : nullptr);
    float most = 0;
    for (const float w : image) most = std::max(most, std::abs(w));
    uint32_t first_row = rows, last_row = 0, first_column = columns, last_column = 0;
    for (uint32_t r = 0; r < rows; ++r) {
        for (uint32_t c = 0; c < columns; ++c) {
            if (std::abs(image[3 * (size_t{r} * columns + c)]) < kLeast * most) continue;
            first_row = std::min(first_row, r), last_row = std::max(last_row, r);
            first_column = std::min(first_column, c), last_column = std::max(last_column, c);
        }
    }
    Kept kept;
    kept.row = static_cast<int32_t>(first_row) - static_cast<int32_t>(key.row << key.depth);
    kept.column = static_cast<int32_t>(first_column) - static_cast<int32_t>(key.column << key.depth);
    kept.rows = last_row - first_row + 1;
    kept.columns = last_column - first_column + 1;
    for (uint32_t r = first_row; r <= last_row; ++r) {
        for (uint32_t c = first_column; c <= last_column; ++c)
            kept.weights.push_back(image[3 * (size_t{r} * columns + c)]);
    }
    return kept;
}

}  // namespace gim
