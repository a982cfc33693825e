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
    std::vector<std::array<float, 3>> face_colors;       // of faces without texture; vertex colours win
    std::vector<std::array<float, 2>> corner_texcoords;  // one per entry of `corners`
    std::vector<uint32_t> face_texture;                  // index of a texture or UINT32_MAX
    bool colors_tint_textures = false;                   // false: textured faces ignore vertex colours

    // As in Shading. Per entry of `corners` an index into normals or kFlat; empty: each vertex has one normal.
    std::vector<std::array<float, 3>> normals;
    std::vector<uint32_t> corner_normals;

    void add_face(std::span<const int64_t> face) {
        corners.insert(corners.end(), face.begin(), face.end());
        sizes.push_back(static_cast<uint32_t>(face.size()));
    }
};

// A place in a list of colours that has none. scale_colors makes it white.
inline constexpr std::array<float, 3> kNoColor = {-1, -1, -1};

// Maps colours to 0..1. They come as 0..1, 0..255 or 0..65535; the largest value tells. So a little above 1 is 1.
void scale_colors(std::vector<std::array<float, 3>>& colors);

// Bytes that a vertex (a corner of a face) takes, in the soup and in the mesh that it becomes.
uint64_t vertex_memory(const ReadContext& context);
uint64_t corner_memory(const ReadContext& context);

// Counts the memory of that many vertices and corners of faces.
Result<void> take_memory(uint64_t vertices, uint64_t corners, ReadContext& context);

// Keeps every vertex and every face in the file's order. Cuts larger faces into triangles inside their outline. Keeps
// degenerate and repeated triangles, because the encoder cleans them. Leaves faces out that have fewer than three
// corners (points and lines), with a warning. Fails without vertices or faces. Otherwise an error names the first face
// that has a corner that is not a vertex. face_texture indexes the textures of the context; the mesh gets them. Without
// normals the mesh gets no shading.
Result<TriangleMesh> triangulate(PolygonSoup soup, ReadContext& context);

}  // namespace gim
