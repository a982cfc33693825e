#include "decoder/domains.h"

#include "decoder/squares/read_squares.h"
#include "decoder/tiles/read_tiles.h"

namespace gim {
namespace {

constexpr DomainReader kSquares = {square_domain_shape, read_square_glue};
constexpr DomainReader kTiles = {tile_domain_shape, read_tile_glue};

}  // namespace

const DomainReader* domain_reader_of(FileLayout layout) {
    if (layout == FileLayout::kSquares) return &kSquares;
    return layout == FileLayout::kTiles ? &kTiles : nullptr;
}

}  // namespace gim
