// What a .gim file gives back, in the shapes that the writers, `compare` and `render` want.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gim/decoder.h"
#include "gim/encoder.h"
#include "tools/file.h"

namespace gim {

// An attribute plane of one image; its side is its own.
struct ImagePlane {
    uint32_t columns = 0, rows = 0;  // 0: the file has none
    std::vector<float> values;       // columns*rows*3, row-major

    bool is_there() const { return columns > 0; }
};

// One level of one image. `grid` is the image itself; the mesh is the same surface with its seams closed.
struct DecodedImage {
    uint32_t columns = 0, rows = 0;
    uint32_t level = 0;
    std::vector<float> grid;               // columns*rows*3, row-major; NaN where undefined
    std::vector<float> grid_normals;       // columns*rows*3
    std::vector<float> grid_texcoords;     // columns*rows*2
    std::vector<uint32_t> grid_triangles;  // index samples
    std::vector<float> positions;          // fused vertices, 3 floats each
    std::vector<float> normals;            // 3 each
    std::vector<float> texcoords;          // 2 each
    ImagePlane normal_map;                 // object space, unit length
    ImagePlane colors;                     // sRGB, 0..1
    std::vector<uint32_t> triangles;       // the same triangles in the same order, index fused vertices

    bool is_defined(size_t sample) const { return grid[3 * sample] == grid[3 * sample]; }
};

// The grid's mesh without undefined samples.
struct GridMesh {
    std::vector<uint32_t> samples;    // per vertex
    std::vector<uint32_t> triangles;  // index vertices
};
GridMesh grid_mesh(const DecodedImage& image);
// Of each vertex, `width` values of a sample.
std::vector<float> at_samples(const GridMesh& mesh, const std::vector<float>& values, size_t width);

// All images of a file at one level; an image that cannot be so coarse gives its coarsest level.
// Fails with kNoSuchLevel's message where no image has the level. Planes, if wanted, come at full resolution whatever the level.
enum class WithPlanes { kNo, kYes };
Result<std::vector<DecodedImage>> decode_images(const Bytes& file, uint32_t level, WithPlanes planes = WithPlanes::kNo);

// All images as one mesh with shared vertices.
TriangleMesh to_mesh(const std::vector<DecodedImage>& images);

// Words for a status of the decoder, with advice.
std::string describe_status(gim_status status);

// Whether the bytes begin like a .gim file of ours.
bool is_gim(const Bytes& file);

}  // namespace gim
