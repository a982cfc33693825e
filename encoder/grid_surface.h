// A geometry image seen as a triangle surface: cells split as the decoder splits them, ring samples that are one
// surface point told by class.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/geometry_image.h"
#include "encoder/mesh.h"
#include "format/seam.h"
#include "gim/encoder.h"

namespace gim {

// Which samples are one surface point. Depends on the sideband only.
struct RingGluing {
    std::vector<uint32_t> representative;       // per sample: the first sample of its class, itself if alone
    std::vector<std::vector<uint32_t>> shared;  // classes of more than one sample, ascending
    std::vector<uint32_t> class_of;             // per sample: index into `shared`, or kNone if alone
    std::vector<Split> split;                   // per cell: which way, where the rim leaves no choice
    std::vector<bool> on_input_boundary;        // per sample: a boundary path of the input's surface passes through it
};

// Fails when the sideband does not describe the ring of an image of that side.
Result<RingGluing> glue_ring(const Sideband& sideband, uint32_t side);

// Two triangles per cell, cell after cell in row-major order, so that triangle t lies in cell t / 2. Wound so that
// (d position / d column) x (d position / d row) is the front.
std::array<Triangle, 2> split_cell(const std::vector<Vec3>& positions, uint32_t side, const RingGluing& gluing,
                                   uint32_t cell);
std::vector<Triangle> triangulate_grid(const std::vector<Vec3>& positions, uint32_t side, const RingGluing& gluing);

}  // namespace gim
