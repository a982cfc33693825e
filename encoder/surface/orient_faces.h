// Turns faces so that they agree, and chooses the side that each component shows.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/surface/weld_places.h"

namespace gim {

struct OrientCounts {
    uint64_t flipped = 0;     // faces turned over
    uint64_t inside_out = 0;  // closed components that show their inner side
};

// In: faces and their joins (join_faces.h), without one-sided pieces. Changes the order of corners in `triangles` and
// `places` and the half-edges in `twin`. Each component keeps the side that most of its faces show. A closed component
// of which more than a quarter show the other side faces outwards.
OrientCounts orient_faces(const std::vector<Point>& positions, std::vector<Triangle>& triangles,
                          std::vector<Triangle>& places, std::vector<uint32_t>& twin);

}  // namespace gim
