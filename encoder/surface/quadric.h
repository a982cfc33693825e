// The sum of weighted squared distances to planes (Garland, Heckbert. Surface Simplification Using Quadric Error
// Metrics. SIGGRAPH 1997).
#pragma once

#include "encoder/surface/mesh.h"

namespace gim {

struct Quadric {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Vec3 b = Vec3::Zero();
    double c = 0;

    // The plane is n.x + d = 0, with n of length 1.
    void add_plane(const Vec3& n, double d, double weight) {
        a += weight * n * n.transpose();
        b += weight * d * n;
        c += weight * d * d;
    }
    Quadric& operator+=(const Quadric& o) {
        a += o.a, b += o.b, c += o.c;
        return *this;
    }
    double operator()(const Vec3& p) const { return p.dot(a * p) + 2 * b.dot(p) + c; }
};

}  // namespace gim
