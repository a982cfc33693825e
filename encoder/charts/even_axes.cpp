#include "encoder/charts/even_axes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace gim {

namespace {

constexpr double kNoExtent = 1e-6;  // of the largest

// Of the area of the surface, about its centroid.
Eigen::Matrix3d covariance_of(const Mesh& mesh) {
    const auto middle = [&](const Triangle& t) -> Vec3 {
        return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
    };
    double area = 0;
    Vec3 centroid = Vec3::Zero();
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        area += face_area(mesh, f);
        centroid += face_area(mesh, f) * middle(mesh.triangles[f]);
    }
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    if (!(area > 0)) return sum;
    centroid /= area;
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        const Vec3 m = 3 * (middle(t) - centroid);
        Eigen::Matrix3d moments = m * m.transpose();
        for (const uint32_t v : t) {
            const Vec3 d = mesh.positions[v] - centroid;
            moments += d * d.transpose();
        }
        sum += face_area(mesh, f) / (12 * area) * moments;
    }
    return sum;
}

}  // namespace

EvenAxes even_axes(const Mesh& mesh) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance_of(mesh));
    const Vec3 extents = axes.eigenvalues().cwiseMax(0).cwiseSqrt();
    const double largest = extents.maxCoeff();
    EvenAxes result;
    Vec3 factors = Vec3::Ones();
    for (int k = 0; k < 3; ++k) {
        if (!(extents[k] > kNoExtent * largest)) continue;
        factors[k] = largest / extents[k];
        result.eccentricity = std::max(result.eccentricity, factors[k]);
    }
    const Eigen::Matrix3d& q = axes.eigenvectors();
    result.into = q * factors.asDiagonal() * q.transpose();
    result.back = q * factors.cwiseInverse().asDiagonal() * q.transpose();
    return result;
}

void map_positions(const Eigen::Matrix3d& map, std::vector<Vec3>& positions) {
    for (Vec3& p : positions) p = map * p;
}

}  // namespace gim
