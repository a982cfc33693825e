// A surface as square tiles of samples on a base mesh of quads: what the layout `tiles` codes.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "format/quad_complex.h"

namespace gim {

struct TileImage {
    std::vector<Quad> quads;  // of vertices 0, 1, ...; counter-clockwise from outside
    uint32_t vertices = 0;
    uint32_t exponent = 0;        // 2^exponent intervals along each side of a tile
    std::vector<Vec3> positions;  // of all samples, numbered as TileSamples numbers them
    bool is_sharp = false;        // lossy: samples lie on creases, which 5/3 keeps better than 9/7
    std::vector<bool> sharp;      // per half-edge: its edge is sharp; empty: no edge is
};

}  // namespace gim
