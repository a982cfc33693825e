// Polygons as a file lists them, and their triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gim/encoder.h"

namespace gim {

struct PolygonSoup {
    std::vector<std::array<double, 3>> positions;
    std::vector<int64_t> corners;  // of all faces, one after the other; unchecked
    std::vector<uint32_t> sizes;   // corners per face

    void add_face(std::span<const int64_t> face) {
        corners.insert(corners.end(), face.begin(), face.end());
        sizes.push_back(static_cast<uint32_t>(face.size()));
    }
};

// Keeps every vertex and every face in the file's order: triangles as they are (also degenerate and repeated ones:
// cleaning them is the encoder's task), larger faces cut into triangles inside their outline. An error names the first
// face that has fewer than three corners or a corner that is no vertex, and the first files without any face.
Result<TriangleMesh> triangulate(PolygonSoup soup);

}  // namespace gim
