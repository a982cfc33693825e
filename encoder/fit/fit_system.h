// The linear system of a round of fitting: normal equations for the displacements of the samples, from sampled
// distances, springs and anchors.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/fit/stencil_solver.h"
#include "encoder/surface/mesh.h"

namespace gim {

// One sampled distance. The weighted sum of the displacements of three corners should be `residual`, mostly along
// `normal`.
struct Pull {
    uint32_t face = kNone;  // of the image; kNone: no pull
    std::array<double, 3> weights{};
    Vec3 residual = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double strength = 0;
};

// Normal equations for the displacements of the samples.
struct FitSystem {
    StencilMatrix matrix;
    std::vector<Vec3> right;  // per sample; the right side of a class is the sum over its samples

    FitSystem(uint32_t width, uint32_t height);
    void add(const Triangle& corners, const Pull& pull);
    // Adds the wish that dx_i - dx_j cancels `difference` = x_i - x_j.
    void add_spring(uint32_t i, uint32_t j, const Eigen::Matrix3d& weight, const Vec3& difference);
    void add_anchor(uint32_t i, const Eigen::Matrix3d& weight, const Vec3& residual);
};

}  // namespace gim
