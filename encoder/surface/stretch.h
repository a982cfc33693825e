// L2 geometric stretch: how far apart, on the surface, the samples of a uniform grid lie.
//
// Sander, Snyder, Gortler, Hoppe. Texture Mapping Progressive Meshes. SIGGRAPH 2001, section 3. For a triangle with
// corners p0 p1 p2 in the plane and q0 q1 q2 in space, the squared singular values of the map plane -> surface sum to
//     a + c = N / D^2,   D = 2 * signed area in the plane,   N = sum_i |q_j - q_k|^2 * -(e_j . e_k),   e_i = p_k - p_j,
// so the squared L2 stretch is N / (2 D^2). It grows without bound as a triangle flattens: its minimiser has no flips.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// The surface's side of the formula, per face.
struct FaceMetric {
    std::array<double, 3> squared_length;  // of the edge opposite each corner
    double weight = 0;                     // half the area on the surface (times importance)
};

// `least_area` bounds the weight of degenerate faces from below, so that they too resist flipping.
FaceMetric face_metric(const Vec3& a, const Vec3& b, const Vec3& c, double least_area);

inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }
inline double twice_signed_area(const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a); }

// weight * N / D^2; infinity for a triangle that is flat or turned over.
double stretch_energy(const FaceMetric& metric, const Vec2& a, const Vec2& b, const Vec2& c);

// 1 / (normalised L2 stretch)^2 of a map into a domain of area `domain_area`: 0..1, 1 = uniform and isotropic
// everywhere.
double stretch_efficiency(const Mesh& mesh, const std::vector<Vec2>& uv, double domain_area);

// A triangle of a vertex's star, seen from the vertex: the other two corners, counter-clockwise, and the metric with
// the vertex as corner 0.
struct StarTriangle {
    Vec2 p1, p2;
    std::array<double, 3> squared_length;
    double weight;
};

// Moves `x` to lower the energy of its star by damped Newton steps that never leave the star's kernel.
// In: x inside the kernel. Returns the energy reached. O(star * steps).
double minimise_star(const std::vector<StarTriangle>& star, Vec2& x, int steps);

// A point well inside the kernel of the star (from which every triangle is counter-clockwise); false if there is none.
bool find_kernel_point(const std::vector<StarTriangle>& star, Vec2& x);

}  // namespace gim
