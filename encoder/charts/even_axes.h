// A linear map that gives a surface about the same extent along all its axes.
//
// Charts are mapped so that samples are equally dense in all directions. A tube that is a thousand times as long as it
// is wide then has no three samples around it. Charts of the mapped surface do, and the map back keeps its topology.
#pragma once

#include "encoder/surface/mesh.h"

namespace gim {

struct EvenAxes {
    Eigen::Matrix3d into = Eigen::Matrix3d::Identity(), back = Eigen::Matrix3d::Identity();
    double eccentricity = 1;  // the largest extent over the smallest one that is not 0
};

// Extents are standard deviations over the surface's area along its principal axes. Axes without extent stay. O(F).
EvenAxes even_axes(const Mesh& mesh);

// Maps all positions.
void map_positions(const Eigen::Matrix3d& map, std::vector<Vec3>& positions);

}  // namespace gim
