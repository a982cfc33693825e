// The arrays of a glTF primitive, rebuilt from the .gim of its mesh. spec/EXT_gim_geometry.md is the authority.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tools/decoded.h"

namespace gim {

// Where the texture coordinates of an image go: (x + size * u, y + size * v).
struct AtlasPlace {
    double x = 0, y = 0, size = 1;
};

struct GimGeometry {
    std::vector<DecodedImage> images;
    std::vector<std::vector<uint8_t>> labels;  // of each image, per cell; empty if the file has none
    std::vector<AtlasPlace> places;            // of each image
};

// Decodes a level, or of each image its coarsest one if that is finer. places: empty, or one for each image.
Result<GimGeometry> decode_geometry(const Bytes& gim, uint32_t level, std::vector<AtlasPlace> places = {});

struct PrimitiveArrays {
    std::vector<float> positions, normals;  // 3 for each vertex
    std::vector<float> texcoords;           // 2; empty unless wanted
    std::vector<float> tangents;            // 4; empty unless wanted
    std::vector<uint32_t> indices;          // 3 for each triangle

    size_t vertices() const { return positions.size() / 3; }
};

struct WantedArrays {
    std::optional<uint32_t> label;  // of the triangles; none: all triangles
    bool texcoords = false;
    bool tangents = false;  // with texcoords only
};
PrimitiveArrays arrays_of(const GimGeometry& geometry, const WantedArrays& wanted);

}  // namespace gim
