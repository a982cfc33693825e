// Computes the energy of a chart's map and its derivatives, per triangle (chart_parametrize.h says why this energy).
//
// A triangle's energy is its area times (importance/2 * (1/s1^2 + 1/s2^2) + s1 s2). s1 and s2 are the singular values
// of the triangle's map. The Hessian's eigensystem is known in closed form: Smith, de Goes, Kim. Analytic Eigensystems
// for Isotropic Distortion Energies. ACM TOG 2019.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <limits>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// A triangle on the surface: gradients of its three hat functions in its own 2D coordinates, its area, its importance.
struct MapElement {
    Eigen::Matrix<double, 2, 3> gradient;
    double area = 0, importance = 1;
};

// importance: per face; empty: 1.
std::vector<MapElement> elements_of(const Mesh& mesh, const std::vector<double>& importance);

// Jacobian of the map that takes the triangle's corners to a, b and c.
inline Eigen::Matrix2d jacobian(const MapElement& e, const Vec2& a, const Vec2& b, const Vec2& c) {
    return a * e.gradient.col(0).transpose() + b * e.gradient.col(1).transpose() + c * e.gradient.col(2).transpose();
}

// Returns the triangle's energy. Infinite if the map turns the triangle over. j: the map's Jacobian.
inline double energy(const MapElement& e, const Eigen::Matrix2d& j) {
    const double det = j.determinant();
    if (!(det > 0)) return std::numeric_limits<double>::infinity();
    return e.area * (0.5 * e.importance * j.squaredNorm() / (det * det) + det);
}

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Computes the gradient and the positive semi-definite part of the Hessian over (a, b, c). j: the map's Jacobian.
void derivatives(const MapElement& e, const Eigen::Matrix2d& j, Vector6& gradient, Matrix6& hessian);

}  // namespace gim
