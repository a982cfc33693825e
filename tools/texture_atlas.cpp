#include "tools/texture_atlas.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace gim {
namespace {

using Vec2 = Eigen::Vector2d;

double twice_area(const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

std::array<Vec2, 3> corners_of(const PrimitiveArrays& arrays, size_t triangle) {
    std::array<Vec2, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
        const size_t v = arrays.indices[3 * triangle + k];
        corners[k] = {double{arrays.texcoords[2 * v]}, double{arrays.texcoords[2 * v + 1]}};
    }
    return corners;
}

// Places squares, the largest first, in rows of a strip. Returns the height.
double shelve(std::span<const double> sides, std::span<const size_t> order, double width, double gap,
              std::vector<AtlasPlace>& places) {
    double x = 0, y = 0, row = 0;
    for (const size_t i : order) {
        if (x > 0 && x + sides[i] > width) {
            y += row + gap;
            x = row = 0;
        }
        places[i] = {x, y, sides[i]};
        x += sides[i] + gap;
        row = std::max(row, sides[i]);
    }
    return y + row;
}

}  // namespace

std::vector<AtlasTexel> texels_of(const PrimitiveArrays& arrays, const AtlasSize& size) {
    std::vector<AtlasTexel> texels;
    std::vector<bool> is_taken(size_t{size.width} * size.height, false);
    const Vec2 scale(size.width, size.height);
    for (size_t t = 0; 3 * t < arrays.indices.size(); ++t) {
        std::array<Vec2, 3> corner = corners_of(arrays, t);
        for (Vec2& c : corner) c = c.cwiseProduct(scale) - Vec2(0.5, 0.5);
        const double area = twice_area(corner[0], corner[1], corner[2]);
        if (area == 0) continue;
        const Vec2 low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]),
                   high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
        for (double row = std::max(0.0, std::ceil(low.y())); row <= std::min(size.height - 1.0, high.y()); ++row) {
            for (double column = std::max(0.0, std::ceil(low.x())); column <= std::min(size.width - 1.0, high.x());
                 ++column) {
                const Vec2 p(column, row);
                const double a = twice_area(p, corner[1], corner[2]) / area,
                             b = twice_area(corner[0], p, corner[2]) / area, c = 1 - a - b;
                if (std::min({a, b, c}) < -1e-6) continue;
                const size_t index = static_cast<size_t>(row) * size.width + static_cast<size_t>(column);
                if (is_taken[index]) continue;
                is_taken[index] = true;
                texels.push_back({static_cast<uint32_t>(index),
                                  static_cast<uint32_t>(t),
                                  {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)}});
            }
        }
    }
    return texels;
}

double covered_share(const PrimitiveArrays& arrays) {
    double share = 0;
    for (size_t t = 0; 3 * t < arrays.indices.size(); ++t) {
        const std::array<Vec2, 3> corner = corners_of(arrays, t);
        share += std::abs(twice_area(corner[0], corner[1], corner[2])) / 2;
    }
    return share;
}

void fill_gaps(std::vector<uint8_t>& pixels, size_t channels, std::vector<bool>& has_value, const AtlasSize& size) {
    std::vector<uint32_t> front, next;
    for (uint32_t i = 0; i < has_value.size(); ++i)
        if (has_value[i]) front.push_back(i);
    while (!front.empty()) {
        next.clear();
        for (const uint32_t i : front) {
            const uint32_t row = i / size.width, column = i % size.width;
            const auto spread = [&](bool is_inside, uint32_t to) {
                if (!is_inside || has_value[to]) return;
                has_value[to] = true;
                std::copy_n(&pixels[channels * i], channels, &pixels[channels * to]);
                next.push_back(to);
            };
            spread(column > 0, i - 1);
            spread(column + 1 < size.width, i + 1);
            spread(row > 0, i - size.width);
            spread(row + 1 < size.height, i + size.width);
        }
        std::swap(front, next);
    }
}

std::vector<AtlasPlace> pack_squares(std::span<const double> sides) {
    constexpr double kGap = 1.0 / 128, kSmallest = 1.0 / 64;  // of the atlas; of the largest square
    std::vector<double> scaled(sides.begin(), sides.end());
    const double largest = *std::max_element(sides.begin(), sides.end());
    for (double& side : scaled) side = std::max(largest > 0 ? side / largest : 1.0, kSmallest);
    std::vector<size_t> order(sides.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return scaled[a] > scaled[b]; });
    std::vector<AtlasPlace> places(sides.size());
    double width = 1;
    while (shelve(scaled, order, width, kGap * width, places) > width) width *= 1.02;
    for (AtlasPlace& place : places) place = {place.x / width, place.y / width, place.size / width};
    return places;
}

}  // namespace gim
