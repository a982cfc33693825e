// Decoded images as files of other formats: PLY, OBJ, OFF, STL, GLB (the surface) and EXR (the image itself).
//
// PLY, OBJ, OFF share the vertices on the cut, so the surface is watertight by its indices. STL repeats every vertex by
// nature. GLB repeats the samples on the cut, with equal positions and normals, because texture coordinates jump there;
// `fused` leaves texture coordinates out and shares the vertices instead. Coordinates are float32 in every format
// (text: shortest decimal form that reads back as the same float). Several images become objects (OBJ), nodes (GLB),
// parts (EXR), else one mesh.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "tools/decoded.h"

namespace gim {

enum class SurfaceFormat { kPly, kObj, kOff, kStl, kGlb, kExr };

std::optional<SurfaceFormat> surface_format_of(std::string_view extension);

struct SurfaceOptions {
    bool fused = false;  // GLB only
};

Result<Bytes> write_surface(SurfaceFormat format, std::span<const DecodedImage> images,
                            const SurfaceOptions& options = {});

// One function per format.
Bytes write_ply(std::span<const DecodedImage> images);  // binary little-endian, with normals
Bytes write_obj(
    std::span<const DecodedImage> images);  // with normals and texture coordinates (right on both sides of the cut)
Bytes write_off(std::span<const DecodedImage> images);
Bytes write_stl(std::span<const DecodedImage> images);  // binary
Result<Bytes> write_glb(std::span<const DecodedImage> images, bool fused);
Result<Bytes> write_exr(std::span<const DecodedImage> images);  // float32 X, Y, Z, mask; ZIP

}  // namespace gim
