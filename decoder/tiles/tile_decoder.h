// The samples of one level of a complex of tiles: streams -> details -> inverse wavelet -> units.
#pragma once

#include <cstdint>
#include <span>

#include "decoder/pyramid/arena.h"
#include "format/container.h"
#include "format/expectation.h"
#include "format/plane_code.h"
#include "format/quad_code.h"
#include "format/quad_complex.h"
#include "format/tile_code.h"

namespace gim {

struct TileWorkspace {
    QuadComplex complex;
    QuadCodeWork quad_code;
    const uint32_t* is_sharp = nullptr;  // per edge: 1 if it is sharp; nullptr if the file does not tell
    BandModels* models = nullptr;
    BandWork band_work;
    TileFlags* flags = nullptr;  // per tile
    int32_t* base = nullptr;     // triples, per vertex
    void* sums = nullptr;        // 6 per vertex, of a TileLifting
    int32_t* details[2] = {};    // of the step being decoded and of the one before, in turn
    void* samples[2] = {};       // int32_t or float, in turn; the level asked for ends in the first
};

// What read_complex needs alone.
TileWorkspace lay_out_complex(const TileShape& shape, Arena* arena);
TileWorkspace lay_out_tiles(const TileShape& shape, uint32_t level, Arena* arena);

// Reads and checks how the tiles are glued, and which edges are sharp. Fills ws.complex and ws.is_sharp. Of ws.quad_code,
// `next` and `previous` are free then.
Status read_complex(const Header& header, std::span<const uint8_t> file, TileWorkspace& ws);

// Decodes a level: per tile (side+1)^2 triples in units, row by row. Samples of one surface point have equal bits.
Status decode_tiles(const Header& header, std::span<const uint8_t> file, uint32_t level, TileWorkspace& ws,
                    float** samples);

// The same for a plane on the complex of ws. shape: that of the plane (tile_plane_shape).
Status decode_tile_samples(const TileShape& shape, const PlaneChunk& plane, uint32_t level, TileWorkspace& ws,
                           float** samples);

}  // namespace gim
