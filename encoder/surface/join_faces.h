// Says which faces continue each other across an edge, so that every edge ends with one or two faces.
//
// Two faces at an edge are joined. Where more meet, the pairs are chosen so that bodies stay closed: a face is joined to
// the one at the other side of the same piece of solid. Faces of open sheets continue as straight as they can. That
// surfaces are cut at such edges and stitched again in pairs is from Gueziec, Taubin, Lazarus, Horn. Cutting and
// Stitching: Converting Sets of Polygons to Manifold Surfaces. 2001. The choice of the pairs is ours.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/surface/topology_summary.h"
#include "encoder/surface/weld_places.h"

namespace gim {

struct FaceJoins {
    std::vector<uint32_t> twin;     // per half-edge: the one that it is joined to; kNone: none
    std::vector<uint32_t> crowded;  // one half-edge for each edge of more than two faces
    std::vector<uint32_t> cut;      // one half-edge for each of these that keeps an open face
};

// triangles: index `positions`, three different points each. known: pairs that are joined already, as `twin`; or empty.
// pair_crowded: false leaves edges of more than two faces as `known` has them.
// Joins faces that run the same way along an edge only if one can be turned over without a contradiction, or if they are
// the edge's only two. Cost: O(F log F).
FaceJoins join_faces(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
                     std::span<const uint32_t> known, bool pair_crowded = true);

// A join, by the corners at its ends: those of the first face and those of the other face at the same places.
struct JoinedCorners {
    uint32_t half_edge = 0;  // of the first face
    uint32_t start = 0, end = 0;
    uint32_t start_of_twin = 0, end_of_twin = 0;
};

// Calls body(join) once for each pair of joined half-edges, in order.
template <class Body>
void for_each_join(std::span<const uint32_t> twin, const std::vector<Triangle>& triangles, const Body& body) {
    for (uint32_t h = 0; h < twin.size(); ++h) {
        const uint32_t g = twin[h];
        if (g == kNone || g < h) continue;
        const bool is_opposite = triangles[h / 3][h % 3] != triangles[g / 3][g % 3];
        body(JoinedCorners{h, h, next(h), is_opposite ? next(g) : g, is_opposite ? g : next(g)});
    }
}

// Numbers the corners of the triangles so that corners of one fan of joined faces share a number. Numbers are in the
// order of the smallest name in the fan, then of the first corner. names: of the corners of each triangle.
struct Fans {
    std::vector<uint32_t> of_corner;
    std::vector<uint32_t> name;  // per fan: the smallest name
};
Fans number_fans(std::span<const uint32_t> twin, const std::vector<Triangle>& triangles,
                 const std::vector<Triangle>& names);

// Pieces of faces that are joined, numbered by their first face.
Components joined_components(std::span<const uint32_t> twin);

}  // namespace gim
