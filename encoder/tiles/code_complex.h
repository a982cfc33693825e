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

// Calls f(tile, row, column) of the image for the samples of each tile of the code, row by row.
template <class F>
void for_each_coded_sample(const CodedComplex& coded, uint32_t side, const F& f) {
    for (size_t h = 0; h < coded.half_edges.size(); h += 4) {
        const uint32_t first = coded.half_edges[h];
        for (uint32_t row = 0; row <= side; ++row) {
            for (uint32_t column = 0; column <= side; ++column) {
                uint32_t r = row, c = column;
                for (uint32_t k = side_of(first); k > 0; --k) {  // turns the tile by a quarter
                    const uint32_t turned = side - r;
                    r = c;
                    c = turned;
                }
                f(tile_of(first), r, c);
            }
        }
    }
}

// For each tile of the code its grid of (side+1)^2 samples, row by row, as numbers of samples of the image.
// complex: that of the image.
std::vector<uint32_t> coded_samples(const CodedComplex& coded, const QuadComplex& complex, uint32_t side);

}  // namespace gim
