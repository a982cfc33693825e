// Reads a file named on the command line, whatever it holds.
#pragma once

#include <string>
#include <vector>

#include "gim/encoder.h"
#include "tools/file.h"
#include "tools/mesh_read.h"

namespace gim {

// A headerless geometry image of another program: side*side*3 float32, all x, then all y, then all z.
struct RawImage {
    uint32_t side = 0;
    std::vector<float> channels;
};

// Reads a file named *.gim that has no header. Its size must be 12 * side * side bytes.
Result<RawImage> read_raw_image(const Bytes& bytes);

// Joins neighbouring samples to triangles along the shorter diagonal. Leaves boundaries apart.
TriangleMesh to_mesh(const RawImage& image);

// Samples on the two sides of a cut differ only by rounding. Samples nearer than this part of the bounding box's
// diagonal are one point.
inline constexpr double kRawWeldTolerance = 2e-6;
double diagonal_of(const RawImage& image);

struct Input {
    enum class Kind { kMesh, kGim, kRawImage };
    Kind kind = Kind::kMesh;
    MeshFormat format = MeshFormat::kUnknown;  // kMesh only
    TriangleMesh mesh;                         // kMesh only
    RawImage raw;                              // kRawImage only
    Bytes bytes;                               // kGim only
    std::vector<std::string> warnings;         // one per missing texture
};

// Reads the file and decides by `format` (an extension), else by content, then by extension. "-" is standard input.
enum class Want { kShape, kShapeAndColors };
Result<Input> read_input(const std::string& path, Want want = Want::kShape, const std::string& format = {});

// Returns any of the three as a mesh for comparing and drawing. Decodes a .gim file at `level`. Welds the vertices of
// formats that repeat them. format: taken if the name has no extension that gim knows.
Result<TriangleMesh> read_surface(const std::string& path, uint32_t level, const std::string& format = {});

}  // namespace gim
