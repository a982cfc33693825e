// The sideband as bits, both ways.  spec/gim-format.md, "SEAM chunk".
// About ten bytes for a surface of genus 0: a path is new, or the mate of a path that is still open - most often of the
// one opened last - and a new path's length is at most half of the ring that is not spoken for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/sideband.h"
#include "format/status.h"

namespace gim {

// Appends the code of one image's sideband. It must satisfy build_seam_table; the node grid is stored as it is.
void append_sideband(const Sideband& sideband, std::vector<uint8_t>* bytes);

// What parse_sideband found; the paths are in the caller's array.
struct ParsedSideband {
    uint32_t node_side = 0;
    uint32_t start = 0;
    uint32_t path_count = 0;
    size_t size = 0;  // bytes read
};

// Reads one image's sideband from the front of `bytes`. kMalformed at the end of the bytes, when there are more paths
// than `paths` holds, and for padding that is not zero.
Status parse_sideband(std::span<const uint8_t> bytes, std::span<CutPath> paths, ParsedSideband* parsed);

// The same sideband on the coarsest node grid that has all its nodes.
Sideband with_coarsest_node_grid(Sideband sideband);

}  // namespace gim
