// The mesh of an image with displacements (gim/refine.h, "details"): fine where they are, as the samples elsewhere.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gim/decoder.hpp"
#include "tools/decoded.h"

namespace gim {

// Replaces the surface of a decoded image, at level 0, by the detailed one. Its grid has the samples that the mesh uses;
// others are undefined. Changes nothing if the file has no displacements.
gim_status add_details(Decoder& decoder, const Bytes& file, uint32_t index, DecodedImage* image);

// The area-weighted normal of each vertex, unit length; 0 where there is none. Triples.
std::vector<float> vertex_normals(std::span<const float> positions, std::span<const uint32_t> triangles);

}  // namespace gim
