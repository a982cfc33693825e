#include "encoder/emboss/picture_heights.h"

#include <algorithm>
#include <cmath>

namespace gim {
namespace {

// The mean of 2 x 2 pixels each; what is beyond the picture is 0.
HeightPicture halved(const HeightPicture& p) {
    HeightPicture half{(p.width + 1) / 2, (p.height + 1) / 2, {}};
    half.heights.assign(size_t{half.width} * half.height, 0.0f);
    for (uint32_t y = 0; y < p.height; ++y) {
        for (uint32_t x = 0; x < p.width; ++x)
            half.heights[size_t{y / 2} * half.width + x / 2] += 0.25f * p.heights[size_t{y} * p.width + x];
    }
    return half;
}

}  // namespace

PictureHeights::PictureHeights(const HeightPicture& picture, double size)
    : pictures_{picture},
      width_(size * picture.width / std::max(picture.width, picture.height)),
      height_(size * picture.height / std::max(picture.width, picture.height)) {
    while (pictures_.back().width > 1 && pictures_.back().height > 1) pictures_.push_back(halved(pictures_.back()));
}

void PictureHeights::filter_for(double spacing) {
    chosen_ = 0;
    while (chosen_ + 1 < pictures_.size() && std::ldexp(pixel(), static_cast<int>(chosen_) + 1) <= spacing) ++chosen_;
}

double PictureHeights::at(const Vec2& place) const {
    if (!(std::abs(place.x()) <= width_ / 2 && std::abs(place.y()) <= height_ / 2)) return 0;
    const HeightPicture& p = pictures_[chosen_];
    // A halved picture may reach a little beyond the edge of the one that it was made of.
    const double scale = pictures_[0].width / width_ / std::exp2(double(chosen_));
    const double x = (place.x() + width_ / 2) * scale - 0.5, y = (height_ / 2 - place.y()) * scale - 0.5;
    const double column = std::floor(x), row = std::floor(y);
    const auto height = [&](double r, double c) {
        if (r < 0 || c < 0 || r >= p.height || c >= p.width) return 0.0;
        return double{p.heights[static_cast<size_t>(r) * p.width + static_cast<size_t>(c)]};
    };
    const double s = y - row, t = x - column;
    return (1 - s) * ((1 - t) * height(row, column) + t * height(row, column + 1)) +
           s * ((1 - t) * height(row + 1, column) + t * height(row + 1, column + 1));
}

}  // namespace gim
