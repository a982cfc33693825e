// Makes smaller files of a .gim file without encoding again: coarser levels only, or without planes and text.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gim/encoder.h"

namespace gim {

struct CutOptions {
    uint32_t level = 0;                  // the finest level to keep
    std::optional<uint64_t> most_bytes;  // if set: the finest level from `level` on that fits into so many bytes
    // What to leave out. A cut that drops levels leaves out displacements too: they lie on the finest level.
    bool drop_normals = false, drop_colors = false, drop_displacements = false, drop_labels = false, drop_text = false;
};

struct CutFile {
    std::vector<uint8_t> bytes;  // a complete .gim file; its level 0 is `level` of the one that was cut
    uint32_t level = 0;          // the finest level kept
};

// file: a .gim file, or the beginning of one that holds all that is kept. It keeps its bits. Fails if an image does not
// have the level, if nothing fits, or if a chunk that is kept is missing or damaged. Cost O(bytes kept).
Result<CutFile> cut(std::span<const uint8_t> file, const CutOptions& options);

}  // namespace gim
