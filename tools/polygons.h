// Polygons as a file lists them, and their triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gim/encoder.h"
#include "tools/read_context.h"

namespace gim {

struct PolygonSoup {
    std::vector<std::array<double, 3>> positions;
    std::vector<int64_t> corners;  // of all faces, one after the other; unchecked
    std::vector<uint32_t> sizes;   // corners per face

    // Colours as in gim/encoder.h. Each array is empty or complete.
    std::vector<std::array<float, 3>> vertex_colors;
    std::vector<std::array<float, 2>> corner_texcoords;  // one per entry of `corners`
    std::vector<uint32_t> face_texture;                  // index of a texture or UINT32_MAX
    bool colors_tint_textures = false;                   // false: textured faces ignore vertex colours

    void add_face(std::span<const int64_t> face) {
        corners.insert(corners.end(), face.begin(), face.end());
        sizes.push_back(static_cast<uint32_t>(face.size()));
    }
};

// Counts the memory of that many vertices and corners of faces, of the soup and of the mesh that it becomes.
Result<void> take_memory(uint64_t vertices, uint64_t corners, ReadContext& context);

// Keeps every vertex and every face in the file's order. Cuts larger faces into triangles inside their outline. Keeps
// degenerate and repeated triangles, because the encoder cleans them. Fails without vertices or faces. Otherwise an
// error names the first face that has fewer than three corners or a corner that is not a vertex. face_texture indexes
// `textures`; the mesh gets them.
Result<TriangleMesh> triangulate(PolygonSoup soup, std::vector<TextureImage> textures = {});

}  // namespace gim
