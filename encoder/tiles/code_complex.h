// Codes how the tiles of an image are glued, and puts them into the order of the code.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/tiles/own_complex.h"
#include "encoder/tiles/tile_image.h"

namespace gim {

// The complex in the order of the code. Its half-edge h was half_edges[h] of the image.
struct CodedComplex {
    OwnComplex complex;
    std::vector<uint32_t> half_edges;
    std::vector<uint8_t> payload;  // of the SEAM chunk
};

// The complex of the image in its own order. An Error names the tile, edge or vertex that is not that of a surface.
Result<OwnComplex> complex_of(const std::vector<Quad>& quads, uint32_t vertices);

CodedComplex code_complex(const TileImage& image, const QuadComplex& complex);

// For each tile of the code its grid of (side+1)^2 samples, row by row, as numbers of samples of the image.
// complex: that of the image.
std::vector<uint32_t> coded_samples(const CodedComplex& coded, const QuadComplex& complex, uint32_t side);

}  // namespace gim
