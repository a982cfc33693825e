// Meshes with a base of tiles and a map to them.
#pragma once

#include <string>
#include <vector>

#include "encoder/tiles/split_chords.h"
#include "encoder/tiles/tile_base.h"
#include "encoder/tiles/tile_map.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {

struct MappedMesh {
    TileInput input;
    TileBase base;
    TileMap map;
};

inline MappedMesh mapped(const Mesh& mesh, uint32_t tiles, double crease_angle = 0,
                         const TileMapOptions& options = {}) {
    MappedMesh m;
    m.input = make_room_for_tiles(mesh, crease_angle > 0 ? find_creases(mesh, crease_angle) : std::vector<bool>{});
    split_chords(m.input.mesh, m.input.sharp);
    m.base = make_tile_base(m.input, BaseHierarchy(m.input.mesh, m.input.sharp), 2 * tiles);
    auto map = map_tiles(m.input.mesh, m.base.base, m.base.pairing.quads, options);
    if (map.ok()) m.map = std::move(map.value());
    return m;
}

}  // namespace gim
