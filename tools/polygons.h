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

    // Colours, as gim/encoder.h has them; each is empty or complete.
    std::vector<std::array<float, 3>> vertex_colors;
    std::vector<std::array<float, 2>> corner_texcoords;  // as `corners`
    std::vector<uint32_t> face_texture;                  // index of a texture or UINT32_MAX
    bool colors_tint_textures = false;                   // else a textured face has no vertex colours

    void add_face(std::span<const int64_t> face) {
        corners.insert(corners.end(), face.begin(), face.end());
        sizes.push_back(static_cast<uint32_t>(face.size()));
    }
};

// Keeps every vertex and every face in the file's order: triangles as they are (also degenerate and repeated ones:
// cleaning them is the encoder's task), larger faces cut into triangles inside their outline. An error names the first
// face that has fewer than three corners or a corner that is no vertex, and the first files without any face.
// `textures`: what face_texture counts; they become the mesh's.
Result<TriangleMesh> triangulate(PolygonSoup soup, std::vector<TextureImage> textures = {});

}  // namespace gim
