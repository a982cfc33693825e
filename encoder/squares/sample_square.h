// Samples the surface at the grid points of the square.
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3: evaluates the parametrization at (i/(n-1), j/(n-1)).
#pragma once

#include <vector>

#include "encoder/base/result.h"
#include "encoder/squares/boundary_map.h"
#include "encoder/squares/square_image.h"
#include "encoder/surface/surface_point.h"

namespace gim {

// Finds the triangle of uv under every grid point of a side x side image, row-major. O(F + side^2).
std::vector<SurfacePoint> locate_samples(const Mesh& mesh, const std::vector<Vec2>& uv, uint32_t side);

// Takes one surface point per grid point. Samples of mates are bit-equal. Cut-nodes are the mesh vertices themselves.
// Fails if the node grid is finer than the image.
Result<SquareImage> sample_surface(const SquareBoundary& boundary, const std::vector<Vec2>& uv, uint32_t side);

}  // namespace gim
