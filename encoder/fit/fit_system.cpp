#include "encoder/fit/fit_system.h"

namespace gim {

namespace {

constexpr double kTangentWeight = 0.003;  // tau

SymmetricBlock symmetric(const Eigen::Matrix3d& m) {
    return {static_cast<float>(m(0, 0)), static_cast<float>(m(0, 1)), static_cast<float>(m(0, 2)),
            static_cast<float>(m(1, 1)), static_cast<float>(m(1, 2)), static_cast<float>(m(2, 2))};
}

}  // namespace

FitSystem::FitSystem(uint32_t width, uint32_t height)
    : matrix(width, height), right(size_t{width} * height, Vec3::Zero()) {}

void FitSystem::add(const Triangle& corners, const Pull& pull) {
    const Vec3& n = pull.normal;
    const double along = pull.strength * (1 - kTangentWeight), across = pull.strength * kTangentWeight;
    const Eigen::Matrix3d weight = along * n * n.transpose() + across * Eigen::Matrix3d::Identity();
    const Vec3 force = weight * pull.residual;
    const SymmetricBlock block = symmetric(weight);
    for (size_t i = 0; i < 3; ++i) {
        right[corners[i]] += pull.weights[i] * force;
        for (size_t j = i; j < 3; ++j) {
            matrix.add(corners[i], corners[j], block, static_cast<float>(pull.weights[i] * pull.weights[j]));
        }
    }
}

void FitSystem::add_spring(uint32_t i, uint32_t j, const Eigen::Matrix3d& weight, const Vec3& difference) {
    const SymmetricBlock block = symmetric(weight);
    matrix.add(i, i, block, 1);
    matrix.add(j, j, block, 1);
    matrix.add(i, j, block, -1);
    const Vec3 force = weight * difference;
    right[i] -= force;
    right[j] += force;
}

void FitSystem::add_anchor(uint32_t i, const Eigen::Matrix3d& weight, const Vec3& residual) {
    matrix.add(i, i, symmetric(weight), 1);
    right[i] += weight * residual;
}

}  // namespace gim
