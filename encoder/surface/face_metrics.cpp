#include "encoder/surface/face_metrics.h"

#include <algorithm>

namespace gim {

namespace {

constexpr double kLeastArea = 1e-3;          // smallest weight of a face, in mean face areas
constexpr double kLeastSqueezedArea = 1e-2;  // the same for its squeeze

}  // namespace

void FaceMetrics::set_least_area(const std::vector<Triangle>& coarsest, size_t faces) {
    double area = 0;
    for (const Triangle& face : coarsest) area += 2 * metric_of(face, 0).weight;
    least_area_ = kLeastArea * area / static_cast<double>(faces);
    least_squeezed_area_ = kLeastSqueezedArea * surface_ / static_cast<double>(faces);
}

FaceMetric FaceMetrics::metric_of(const Triangle& face, double least_area) const {
    const auto [a, b, c] = face;
    FaceMetric metric = face_metric(positions_[a], positions_[b], positions_[c], least_area);
    metric.squeeze = squeeze_ / std::max(2 * metric.weight, least_squeezed_area_);
    if (!importance_.empty()) metric.weight *= (importance_[a] + importance_[b] + importance_[c]) / 3;
    return metric;
}

}  // namespace gim
