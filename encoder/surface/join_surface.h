// Makes a surface of the faces of a file: welds vertices, drops what is no face, and joins faces across edges.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/surface/clean.h"
#include "encoder/surface/join_faces.h"
#include "encoder/surface/weld_places.h"

namespace gim {

struct JoinedSurface {
    std::vector<Triangle> triangles;  // of the input, those that are left
    std::vector<Triangle> places;     // the same by place
    std::vector<uint32_t> place;      // per input vertex: the smallest vertex at its place
    FaceJoins joins;
    double resolution = 0;  // triangles that are not thicker have no area; 0: all have
    Repairs repairs;        // what was welded and dropped
};

// In: numbers that check_numbers accepts. Out: every edge has at most two joined faces. If options.strict, an Error says
// where the surface is no oriented manifold.
Result<JoinedSurface> join_surface(const TriangleMesh& input, const CleanOptions& options);

}  // namespace gim
