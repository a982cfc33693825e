// Writes decoded images in other formats: PLY, OBJ, OFF, STL, GLB (the surface) and EXR (the image itself).
//
// PLY, OBJ and OFF share the vertices on the cut, so the surface is watertight by its indices. STL repeats every vertex
// by nature. GLB repeats the samples on the cut, with equal positions and normals, because texture coordinates jump
// there. With `fused` it leaves out texture coordinates and shares the vertices. Normals differ on both sides of sharp
// edges: OBJ and GLB say so. PLY has one normal for each vertex, and repeats the vertices there only with `split_sharp`.
// Several images become objects (OBJ), nodes (GLB), parts (EXR), or else one mesh.
//
// Coordinates are float32 in every format (text: shortest decimal form that reads back as the same float). Those of
// images with an origin are float64 in PLY, OBJ and OFF, relative to the node's translation in GLB, relative to the
// attribute gimOrigin in EXR, and rounded in STL.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/decoded.h"

namespace gim {

enum class SurfaceFormat { kPly, kObj, kOff, kStl, kGlb, kExr };

std::optional<SurfaceFormat> surface_format_of(std::string_view extension);

struct SurfaceOptions {
    bool fused = false;              // GLB only
    bool split_sharp = false;        // PLY only
    std::string material_file = {};  // OBJ only: what mtllib names; empty: none
};

// Says what a format that has float32 only does to images with an origin. Empty: nothing that a user must know.
std::string rounding_warning(SurfaceFormat format, std::span<const DecodedImage> images);

Result<Bytes> write_surface(SurfaceFormat format, std::span<const DecodedImage> images,
                            const SurfaceOptions& options = {});

// One function per format. PLY and OBJ store colours at the vertices. GLB stores them as base-colour texture, and a
// normal map as tangent-space normal texture (both PNG).
Bytes write_ply(std::span<const DecodedImage> images, bool split_sharp = false);  // binary little-endian, with normals
// With normals and texture coordinates (right on both sides of the cut). Material i of the file is "image<i>".
Bytes write_obj(std::span<const DecodedImage> images, const std::string& material_file = {});
Bytes write_off(std::span<const DecodedImage> images);
Bytes write_stl(std::span<const DecodedImage> images);  // binary
Result<Bytes> write_glb(std::span<const DecodedImage> images, bool fused);
Result<Bytes> write_exr(std::span<const DecodedImage> images);  // float32 X, Y, Z, mask; ZIP

// Writes columns*rows triples as three float32 channels with these names.
Result<Bytes> write_triples_exr(uint32_t columns, uint32_t rows, const std::vector<float>& values,
                                const std::array<const char*, 3>& channels);

// Maps a texture coordinate so that 0 and 1 become the centres of the first and last of `pixels` pixels, where
// renderers expect the pixels' values. 0 pixels: unchanged.
float texture_coordinate(float t, uint32_t pixels);

}  // namespace gim
