// The sideband as bits, both ways.  spec/gim-format.md, "SEAM chunk".
// A surface of genus 0 takes about ten bytes. A path is new, or it is the mate of an open path, most often of the one
// opened last. A new path that will have a mate fills at most half of the free part of the ring.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/sideband.h"
#include "format/status.h"

namespace gim {

// Appends the code of one image's sideband, which must satisfy build_seam_table. Keeps the node grid as it is.
void append_sideband(const Sideband& sideband, std::vector<uint8_t>* bytes);

// What parse_sideband found; the paths are in the caller's array.
struct ParsedSideband {
    uint32_t node_side = 0;
    uint32_t start = 0;
    uint32_t path_count = 0;
    size_t size = 0;  // bytes read
};

// Reads one image's sideband from the front of `bytes`. Returns kMalformed if the bytes end too early, if `paths`
// cannot hold all paths, or if padding is not zero.
Status parse_sideband(std::span<const uint8_t> bytes, std::span<CutPath> paths, ParsedSideband* parsed);

// Returns the same sideband on the coarsest node grid that has all its nodes.
Sideband with_coarsest_node_grid(Sideband sideband);

}  // namespace gim
