// Intermediate states for the caller's pictures (Observer).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "encoder/image/geometry_image.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Shows a mesh that is open along its cut, with its parametrization.
Snapshot make_snapshot(std::string name, std::string caption, const Mesh& opened,
                       std::vector<std::array<uint32_t, 2>> cut, const std::vector<Vec2>& uv);

// Shows a geometry image as a surface. The cut is where the grid of triangles ends.
Snapshot make_snapshot(std::string name, std::string caption, const GeometryImage& image);

// Returns the edges of a closed loop of vertices.
std::vector<std::array<uint32_t, 2>> edges_of_loop(const std::vector<uint32_t>& loop);

}  // namespace gim
