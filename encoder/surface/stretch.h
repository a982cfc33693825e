// L2 geometric stretch: how far apart, on the surface, the samples of a uniform grid lie.
//
// Sander, Snyder, Gortler, Hoppe. Texture Mapping Progressive Meshes. SIGGRAPH 2001, section 3. For a triangle with
// corners p0 p1 p2 in uv and q0 q1 q2 in space, the squared singular values of the map uv -> surface sum to
//     a + c = N / D^2,   D = 2 * signed area in uv,   N = sum_i |q_j - q_k|^2 * -(e_j . e_k),   e_i = p_k - p_j,
// so the squared L2 stretch is N / (2 D^2). It is unbounded as a triangle flattens, so its minimiser has no flips.
//
// Stretch punishes samples that lie far apart, not samples that crowd in one direction. A squeeze punishes them:
//     1/a + 1/c = N / (4 A^2),   A = the triangle's area on the surface,
// is the same sum for the inverse map. Stretch plus squeeze is the symmetric Dirichlet energy of Smith, Schaefer.
// Bijective Parameterization with Free Boundaries. SIGGRAPH 2015.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// The part of the formula that depends on the surface, per face.
struct FaceMetric {
    std::array<double, 3> squared_length;  // of the edge opposite each corner
    double weight = 0;                     // half the area on the surface (times importance)
    double squeeze = 0;                    // weight of N alone; 0: squeezing is free
};

// `least_area` bounds the area in the weight from below, so that degenerate faces resist flipping too.
FaceMetric face_metric(const Vec3& a, const Vec3& b, const Vec3& c, double least_area);

inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }
inline double twice_signed_area(const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a); }

// What squeezing the surface costs in a map, against stretching it. More leaves fewer folds and takes more bytes on smooth
// scans and machined parts (spec/rationale.md). Lossless images have finer steps and need less.
inline constexpr double kCodedSqueeze = 1, kLosslessSqueeze = 0.2;

// Returns weight * N / D^2 + squeeze * N, or infinity if the triangle is flat or turned over.
double stretch_energy(const FaceMetric& metric, const Vec2& a, const Vec2& b, const Vec2& c);

// Returns 1 / (normalised L2 stretch)^2 of a map into a domain of area `domain_area`. Range 0..1; 1 means uniform and
// isotropic everywhere.
double stretch_efficiency(const Mesh& mesh, const std::vector<Vec2>& uv, double domain_area);

// A triangle of a vertex's star, seen from the vertex: the other two corners, counter-clockwise, and the metric with
// the vertex as corner 0.
struct StarTriangle {
    Vec2 p1, p2;
    std::array<double, 3> squared_length;
    double weight = 0, squeeze = 0;
};

// Moves `x` by damped Newton steps that lower the energy of its star and never leave the star's kernel.
// `x` must start inside the kernel. Returns the energy reached. O(star * steps).
double minimise_star(const std::vector<StarTriangle>& star, Vec2& x, int steps);

// The same along one axis (0: x, 1: y) or in any direction. Returns the energies at both ends.
inline constexpr int kAnyDirection = -1;
struct StarDescent {
    double before = 0, after = 0;
};
StarDescent descend_star(const std::vector<StarTriangle>& star, Vec2& x, int steps, int axis);

// Finds a point well inside the kernel of the star, from which every triangle is counter-clockwise. Returns false if
// there is none.
// margin: how far beyond the star's bounding box the point may lie, in sides of the box. The kernel of an open star may
// lie beside its triangles.
bool find_kernel_point(const std::vector<StarTriangle>& star, Vec2& x, double margin = 0);

}  // namespace gim
