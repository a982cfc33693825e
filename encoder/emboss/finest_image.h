// The finest level of one image of a file, as an editor wants it: the mesh, and where its vertices lie in the image.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/surface/mesh.h"
#include "gim/decoder.h"
#include "gim/decoder.hpp"

namespace gim {

struct FinestImage {
    Mesh mesh;
    std::vector<Vec3> normals;                     // per vertex, unit
    std::vector<std::array<double, 2>> texcoords;  // per vertex
    uint32_t width = 0, height = 0;                // of the image, in samples
    uint32_t tiles = 0, intervals = 0;             // as gim_domain_info has them
    uint32_t slot = 0;                             // samples from one tile to the next
    std::vector<uint32_t> vertex_at;               // per sample of the image; kNone between tiles

    uint32_t columns() const { return width / slot; }
    // The first sample of a tile.
    uint32_t row_of(uint32_t tile) const { return tile / columns() * slot; }
    uint32_t column_of(uint32_t tile) const { return tile % columns() * slot; }
};

// The decoder has read the file. An Error if the layout has no tiles, or the file does not decode.
Result<FinestImage> finest_image(Decoder& decoder, std::span<const uint8_t> file, uint32_t image);

}  // namespace gim
