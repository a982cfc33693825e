// Cuts one-sided surfaces (like a Moebius strip) open, so that their faces can be oriented.
//
// A walk around a one-sided surface can come back turned over. The shortest such loop of edges is cut, and again, until
// none is left. Edges on a boundary cost nothing, so a strip is cut across where that is shorter than along.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/surface/weld_places.h"

namespace gim {

// Says for each face whether it must be turned over, so that joined faces agree.
struct Turning {
    std::vector<uint8_t> turn;             // per face
    std::vector<uint32_t> contradictions;  // half-edges across which `turn` fails, one per edge
};
// twin: as in FaceJoins. Nearly O(F).
Turning find_turning(const std::vector<Triangle>& triangles, std::span<const uint32_t> twin);

// Takes joins away until find_turning finds no contradiction. Returns a half-edge of each edge that was cut. Searches
// from at most 64 points of each contradiction, so very long loops may be longer than need be.
// Cost: O(64 F log F) for each loop.
std::vector<uint32_t> cut_one_sided(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
                                    std::vector<uint32_t>& twin);

}  // namespace gim
