// Bounds of clusters: balls, normal cones, and how far a coarse cell is from the samples within it.
//
// Bounds are computed in binary64 from binary32 positions, and rounded outwards by more than a caller errs who tests in
// binary32 (gim/clusters.h).
#pragma once

#include <cstdint>
#include <span>

#include "decoder/refine/quad_domain.h"

namespace gim {

struct Ball {
    float center[3] = {}, radius = 0;
};

// Holds the positions of the vertices; there is at least one. Cost: O(vertices).
Ball ball_around(const QuadDomain& domain, std::span<const uint32_t> vertices);
// Enlarges the radius so that the other ball lies within.
void include_ball(const Ball& other, Ball* ball);

// gim_cluster says how cones are tested.
struct Cone {
    float apex[3] = {}, axis[3] = {}, cutoff = 1;
};

Cone no_cone(const Ball& around);  // culls nothing

// Unit normal of a triangle, in binary64. kNone: it has no area, so it is seen from nowhere. kUnsure: it is so thin that
// rounding decides where it looks.
enum class Facing { kFine, kNone, kUnsure };
Facing face_normal(const QuadDomain& domain, const uint32_t* vertices, double* normal);

struct Normal {
    float x[3];
};
// About the axis of the narrowest cone that holds them. Normals of length 0 do not turn it.
void middle_of_normals(std::span<const Normal> normals, float* axis);

// The narrowest cone around `axis` that holds the normals of all triangles that are added.
class ConeFit {
  public:
    // axis: any length. around: a ball that holds the triangles.
    ConeFit(const float* axis, const Ball& around);
    // Returns whether there can still be a cone.
    bool add(const QuadDomain& domain, const uint32_t* vertices);
    Cone finish() const;

  private:
    Ball around_;
    float axis_[3];
    double least_ = 1;  // cosine between the axis and a normal
    double back_ = 0;   // how far behind the centre the apex must lie
    bool is_there_ = true;
};

// A square of a tile, `size` samples a side, that two triangles stand for.
struct CoarseCell {
    uint32_t tile, row, column, size;
    bool is_main;  // split from its first sample to its last one
};
// No point of the two triangles is farther from the finest surface in the same square, and none of that one is farther from
// the triangles: the largest distance between points at equal places. Cost: O(samples in the cell).
float cell_error(const QuadDomain& domain, const CoarseCell& cell);

}  // namespace gim
