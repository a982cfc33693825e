// What to tell people of the repairs of a mesh.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/surface/weld_places.h"
#include "gim/encoder.h"

namespace gim {

// Where repairs were made: middles of edges, vertices.
struct RepairPlaces {
    std::vector<Vec3> crowded, cut, slits, touching, slivers;
};

std::vector<Vec3> middles_of(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
                             const std::vector<uint32_t>& half_edges);

// One line for each kind of repair that changes what the file shows: always for new boundaries, for others above a
// thousandth of the triangles. Names the first few places.
std::vector<std::string> repair_warnings(const Repairs& repairs, const RepairPlaces& places, uint64_t triangles);

}  // namespace gim
