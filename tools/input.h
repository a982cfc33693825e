// What a path given on the command line turns out to hold.
#pragma once

#include <string>
#include <vector>

#include "gim/encoder.h"
#include "tools/file.h"
#include "tools/mesh_read.h"

namespace gim {

// A headerless geometry image of other people: side*side*3 float32, planar (all x, all y, all z).
struct RawImage {
    uint32_t side = 0;
    std::vector<float> channels;
};

// Of a file named *.gim that is none of ours. The size must be 12 * side * side bytes.
Result<RawImage> read_raw_image(const Bytes& bytes);

// Neighbouring samples joined to triangles (shorter diagonal), boundaries left apart.
TriangleMesh to_mesh(const RawImage& image);

// Samples on both sides of a cut differ by rounding only; this much of the bounding box's diagonal is one point.
inline constexpr double kRawWeldTolerance = 2e-6;
double diagonal_of(const RawImage& image);

struct Input {
    enum class Kind { kMesh, kGim, kRawImage };
    Kind kind = Kind::kMesh;
    MeshFormat format = MeshFormat::kUnknown;  // kMesh only
    TriangleMesh mesh;                         // kMesh only
    RawImage raw;                              // kRawImage only
    Bytes bytes;                               // kGim only
    std::vector<std::string> warnings;         // textures that are missing
};

// Reads the file and decides by content, then by extension.
enum class Want { kShape, kShapeAndColors };
Result<Input> read_input(const std::string& path, Want want = Want::kShape);

// Any of the three as a mesh for comparing and drawing: a .gim decoded at `level`; formats that repeat vertices welded.
Result<TriangleMesh> read_surface(const std::string& path, uint32_t level);

}  // namespace gim
