// glTF to a GLB whose meshes are .gim, and back. spec/EXT_gim_geometry.md
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "gim/encoder.h"
#include "tools/file.h"
#include "tools/read_context.h"

namespace gim {

struct GlbEncodeOptions {
    EncodeOptions mesh;        // of each mesh; the layout is not mcgim
    std::string fallback_uri;  // of the second buffer, with the decoded arrays; empty: none
    // Called before each mesh: its number, how many there are, its name. Returns the callback for its encoding.
    std::function<Progress(size_t mesh, size_t count, const std::string& name)> begin_mesh;
};

struct GlbMeshReport {
    std::string name;
    bool is_carried = false;   // false: it stays as it was
    uint64_t plain_bytes = 0;  // of its arrays without compression
    uint64_t gim_bytes = 0;
    double psnr = 0;
    EncodeReport report = {};
};

struct EncodedGlb {
    Bytes glb, fallback;  // fallback: empty if there is none
    std::vector<GlbMeshReport> meshes;
};

// Encodes the meshes of a glTF file each in its own space. All else of the file stays as it is, as far as it does not
// belong to what is replaced. Meshes that cannot become .gim stay too, with a warning in the context.
Result<EncodedGlb> encode_glb(std::string_view text, ReadContext& context, const GlbEncodeOptions& options);

// Gives all primitives plain arrays: those of a level, or of the coarsest level that a mesh has.
Result<Bytes> decode_glb(std::string_view text, ReadContext& context, uint32_t level);

// True if a .gltf or .glb has meshes that are .gim.
bool has_gim_geometry(std::string_view text);

}  // namespace gim
