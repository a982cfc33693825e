// A frame in which two surfaces can be compared although squares of their coordinates would leave the range of doubles,
// or their distance from 0 would take the digits of their distances.
#pragma once

#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Positions in the frame are (position - origin) / 2^exponent. Surfaces of ordinary size near 0 keep theirs.
struct CompareFrame {
    Vec3 origin = Vec3::Zero();
    int exponent = 0;
};

// Positions of the vertices that triangles use must be finite.
CompareFrame choose_compare_frame(const Mesh& reference, const Mesh& test);

void move_into(const CompareFrame& frame, Mesh& mesh);
// Turns lengths and places back into object space.
void move_out_of(const CompareFrame& frame, Comparison& comparison);

}  // namespace gim
