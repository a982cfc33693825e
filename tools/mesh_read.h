// Reads triangle meshes: PLY (ascii, binary of either byte order), OBJ, OFF, STL (ascii, binary), glTF 2 and GLB.
//
// All formats have readers of our own; read_gltf.cpp says why glTF has one. OpenMesh 9.0 loses what the encoder needs,
// even with a custom importer that bypasses its half-edges. Its coordinates pass through float (4300000.125 becomes
// 4300000). A "nan" in a text file turns the rest of it into zeros or stale indices without an error. Its STL reader
// drops degenerate triangles and merges equal vertices. A header that claims 2^31 elements aborts the program. The tests
// read the files that gim writes with OpenMesh, as a second opinion.
//
// Readers keep every vertex and face in file order and cut faces with more than three corners into triangles. They keep
// non-finite coordinates; the cleaning stage reports them. No reader allocates more than
// ReadContext::memory allows; it asks before it allocates.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "gim/encoder.h"
#include "tools/read_context.h"

namespace gim {

enum class MeshFormat { kUnknown, kPly, kObj, kOff, kStl, kGltf };

// Detects the format by content, else by extension (lower case, without dot).
MeshFormat detect_format(std::span<const uint8_t> bytes, std::string_view extension);

// "PLY", "OBJ", ...
std::string_view format_name(MeshFormat format);

// True if the format repeats one surface point as several vertices: STL always, glTF where attributes differ.
bool repeats_vertices(MeshFormat format);

// Messages begin with "not a mesh that gim can read: ". The caller names the file. Warnings go to the
// context, those of its textures too.
Result<TriangleMesh> read_mesh(std::span<const uint8_t> bytes, MeshFormat format, ReadContext& context);

// One function per format, in read_*.cpp. Their messages lack the common beginning.
Result<TriangleMesh> read_ply(std::string_view text, ReadContext& context);
Result<TriangleMesh> read_obj(std::string_view text, ReadContext& context);
Result<TriangleMesh> read_off(std::string_view text, ReadContext& context);
Result<TriangleMesh> read_stl(std::string_view text, ReadContext& context);
Result<TriangleMesh> read_gltf(std::string_view text, ReadContext& context);

// What the content of a file tells about it. `text` may be binary.
bool is_off_keyword(std::string_view word);       // of any OFF dialect, those that read_off refuses too
bool is_ascii_stl(std::string_view text);         // its first solid begins as one
bool is_whole_binary_stl(std::string_view text);  // its size is what its header claims

// Merges vertices at exactly equal positions into the first of them and drops triangles that collapse. So two samples
// on one quantized point become an edge of length zero, not a hole. Keeps the order. O(V log V).
TriangleMesh weld_equal_positions(const TriangleMesh& mesh);

}  // namespace gim
