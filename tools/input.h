// Reads a file named on the command line, whatever it holds.
#pragma once

#include <string>
#include <vector>

#include "gim/encoder.h"
#include "tools/file.h"
#include "tools/mesh_read.h"
#include "tools/raster_file.h"

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
    enum class Kind { kMesh, kGim, kRawImage, kRaster };
    Kind kind = Kind::kMesh;
    MeshFormat format = MeshFormat::kUnknown;  // kMesh only
    TriangleMesh mesh;                         // kMesh only
    RawImage raw;                              // kRawImage only
    RasterImage raster;                        // kRaster only
    Bytes bytes;                               // kGim only
    std::vector<std::string> warnings;         // what the mesh lost on its way in, one line each
};

enum class Want { kShape, kShapeAndColors };

struct ReadOptions {
    Want want = Want::kShape;
    uint64_t max_memory = default_max_memory();  // bytes that the file and the mesh in it may take
    std::string format = {};                     // an extension that tells the format; empty: the content does
    bool shading = false;                        // also read TriangleMesh::shading
    RasterOptions raster = {};
};

// Reads the file and decides by options.format, else by content, then by extension. "-" is standard input.
Result<Input> read_input(const std::string& path, const ReadOptions& options = {});

// Returns any of them but an .npz or .exr image as a mesh for comparing and drawing. Decodes a .gim file at `level`. Welds the vertices of
// formats that repeat them. options.format: taken if the name has no extension that gim knows. `warnings`: takes those
// of the input; null: nobody wants them.
Result<TriangleMesh> read_surface(const std::string& path, uint32_t level, const ReadOptions& options = {},
                                  std::vector<std::string>* warnings = nullptr);

}  // namespace gim
