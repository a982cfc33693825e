// A decoded .gim file, in the form that the writers, `compare` and `render` take.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gim/decoder.h"
#include "gim/encoder.h"
#include "tools/file.h"

namespace gim {

// An attribute plane of one image. Its side may differ from the image's.
struct ImagePlane {
    uint32_t columns = 0, rows = 0;  // 0: the file has none
    std::vector<float> values;       // columns*rows*3, row-major

    bool is_there() const { return columns > 0; }
};

// A mesh whose vertices on sharp edges are split, with the normals of both sides.
struct HardMesh {
    std::vector<float> positions;     // 3 each; first the fused vertices, then copies of those on sharp edges
    std::vector<float> normals;       // 3 each
    std::vector<float> texcoords;     // 2 each
    std::vector<uint32_t> triangles;  // in the order of the fused ones

    bool is_there() const { return !positions.empty(); }
};

// One level of one image. `grid` is the image itself. The mesh is the same surface with closed seams.
struct DecodedImage {
    uint32_t columns = 0, rows = 0;
    uint32_t level = 0;
    std::array<double, 3> origin = {};     // what all positions below are relative to; 0 unless the file needs it
    std::vector<float> grid;               // columns*rows*3, row-major; NaN where undefined
    std::vector<float> grid_normals;       // columns*rows*3
    std::vector<float> grid_texcoords;     // columns*rows*2
    std::vector<uint32_t> grid_triangles;  // index samples
    std::vector<float> positions;          // fused vertices, 3 floats each
    std::vector<float> normals;            // 3 each
    std::vector<float> texcoords;          // 2 each
    ImagePlane normal_map;                 // object space, unit length
    ImagePlane colors;                     // sRGB, 0..1
    std::vector<uint32_t> triangles;       // index fused vertices; the order is that of grid_triangles
    HardMesh hard;                         // empty if the file tells of no sharp edges

    bool is_defined(size_t sample) const { return grid[3 * sample] == grid[3 * sample]; }
    bool is_relative() const { return origin != std::array<double, 3>{}; }
    // The position of a fused vertex in object space.
    std::array<double, 3> vertex(size_t v) const { return in_space(&positions[3 * v]); }
    std::array<double, 3> in_space(const float* position) const {
        return {origin[0] + double{position[0]}, origin[1] + double{position[1]}, origin[2] + double{position[2]}};
    }
    // Normals of the samples of the grid. Those on sharp edges are those of their side.
    std::vector<float> shading_normals() const;
};

// The grid's mesh without undefined samples.
struct GridMesh {
    std::vector<uint32_t> samples;    // per vertex
    std::vector<uint32_t> triangles;  // index vertices
};
GridMesh grid_mesh(const DecodedImage& image);
// Returns `width` values for each vertex, those of its sample.
std::vector<float> at_samples(const GridMesh& mesh, const std::vector<float>& values, size_t width);

// Decodes all images of a file at one level. An image without that level gives its coarsest one. Fails with the text of
// GIM_NO_SUCH_LEVEL if no image has the level. Planes always have full resolution.
// Displacements change the surface of level 0 only (details.h).
enum class WithPlanes { kNo, kYes };
enum class WithDetails { kNo, kYes };
Result<std::vector<DecodedImage>> decode_images(const Bytes& file, uint32_t level, WithPlanes planes = WithPlanes::kNo,
                                                WithDetails details = WithDetails::kYes);

// All images as one mesh with shared vertices. It has shading if an image has sharp edges.
TriangleMesh to_mesh(const std::vector<DecodedImage>& images);

// Describes a status of the decoder and says what to do.
std::string describe_status(gim_status status);

// True if the bytes begin like a .gim file with a header.
bool is_gim(const Bytes& file);

}  // namespace gim
