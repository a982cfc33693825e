// Reads triangle meshes: PLY (ascii, binary of either byte order), OBJ, OFF, STL (ascii, binary), glTF 2 and GLB.
//
// The text and the simple binary formats have readers of our own, because OpenMesh's (9.0, also behind a custom
// importer that bypasses its half-edges) lose what the encoder needs: coordinates pass through float (4300000.125
// becomes 4300000), a "nan" in a text file turns the rest of it into zeros or stale indices without an error, STL drops
// degenerate and merges equal vertices, and a header that claims 2^31 elements aborts the program. glTF goes through
// tinygltf. OpenMesh is the tests' second opinion on the files that gim writes.
//
// Every vertex and face is kept in file order, faces with more than three corners are triangulated, non-finite
// coordinates are kept for the cleaning stage to report. No reader allocates more than a small multiple of the file's
// size.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "gim/encoder.h"
#include "tools/textures.h"

namespace gim {

enum class MeshFormat { kUnknown, kPly, kObj, kOff, kStl, kGltf };

// By content where it tells, else by extension (lower case, without dot).
MeshFormat detect_format(std::span<const uint8_t> bytes, std::string_view extension);

// "PLY", "OBJ", ...
std::string_view format_name(MeshFormat format);

// STL always and glTF where attributes differ repeat one surface point as several vertices; the others need not.
bool repeats_vertices(MeshFormat format);

// Messages do not name the file (the caller does); they begin with "not a mesh that gim can read: ".
// `folder` is where a .gltf finds its buffers. `textures`: takes warnings, and textures until they are the mesh's; nullptr:
// only the shape is wanted, colours and textures are left out.
Result<TriangleMesh> read_mesh(std::span<const uint8_t> bytes, MeshFormat format, const std::string& folder,
                               Textures* textures = nullptr);

// One function per format, in read_*.cpp. Messages without the common beginning.
Result<TriangleMesh> read_ply(std::string_view text, Textures* textures);
Result<TriangleMesh> read_obj(std::string_view text, Textures* textures);
Result<TriangleMesh> read_off(std::string_view text);
Result<TriangleMesh> read_stl(std::string_view text);
Result<TriangleMesh> read_gltf(std::string_view text, const std::string& folder, Textures* textures);

// Vertices at exactly equal positions become one (the first), triangles that collapse by it are dropped: two samples that fell
// on one quantized point are an edge of length zero, not a hole. Order is kept. O(V log V).
TriangleMesh weld_equal_positions(const TriangleMesh& mesh);

}  // namespace gim
