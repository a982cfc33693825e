// The table of decoder/layouts.cpp for gim/refine: what opening a domain asks of a layout, so that the decoder of levels
// stays out of the module.
#include "decoder/layouts.h"

#include "decoder/squares/read_squares.h"
#include "decoder/tiles/read_tiles.h"

namespace gim {
namespace {

Status refuse_level(const LevelRequest&, gim_level_info*) { return Status::kBadArgument; }
Status refuse_plane(const LevelRequest&, const Chunk&, uint64_t, PlaneLevel*) { return Status::kBadArgument; }

constexpr LevelReader opening(decltype(LevelReader::level_info) level_info,
                              decltype(LevelReader::open_plane) open_plane) {
    return {level_info, nullptr, nullptr, nullptr, open_plane, nullptr, nullptr};
}

// In the order of FileLayout. Charts have no domains.
constexpr LevelReader kReaders[] = {
    opening(square_level_info, open_square_plane),
    opening(refuse_level, refuse_plane),
    opening(tile_level_info, open_tile_plane),
};

}  // namespace

const LevelReader& reader_of(FileLayout layout) { return kReaders[static_cast<size_t>(layout)]; }

}  // namespace gim
