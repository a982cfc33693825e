// Seams: which boundary samples of an image are one point of the surface, and at which levels the glued samples make an
// indexed 2-manifold.  spec/gim-format.md, "Seams".
// After: Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Sections 3.3 and 4. We add the conditions under which a
// coarser level is still a surface, and the rule for the diagonals that keeps it one.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "format/ring.h"
#include "format/sideband.h"
#include "format/split.h"
#include "format/status.h"

namespace gim {

inline constexpr uint32_t kMaxCutPaths = 1024;  // of one image; bounds the memory below
inline constexpr uint32_t kMaxSideExponent = 14;

constexpr bool is_grid_side(uint32_t side) {
    return side >= 2 && ((side - 1) & (side - 2)) == 0 && side <= (1u << kMaxSideExponent) + 1;
}

// A checked sideband in fixed memory (10 KiB), with the cut-nodes sorted into classes.
struct SeamTable {
    uint32_t node_side = 2;
    uint32_t path_count = 0;  // 0: an open square, glued nowhere
    uint32_t node_class_count = 0;
    std::array<uint32_t, kMaxCutPaths + 1> first;   // node-grid ring index of each path's first node; rises from the
                                                    // start and runs past the ring's length instead of wrapping
    std::array<uint32_t, kMaxCutPaths> mate;        // index of the mate, or kNoMate
    std::array<uint16_t, kMaxCutPaths> node_class;  // class of each path's first node

    uint32_t length(uint32_t path) const { return first[path + 1] - first[path]; }
};

// Checks a sideband and fills the table. Without paths the square is open, whatever the other arguments. Returns
// kMalformed unless node_side is 2^j+1, the lengths fill the ring, and mates are mutual, distinct and equally long.
Status build_seam_table(uint32_t node_side, uint32_t start, std::span<const CutPath> paths, SeamTable* table);
inline Status build_seam_table(const Sideband& sideband, SeamTable* table) {
    return build_seam_table(sideband.node_side, sideband.start, sideband.paths, table);
}

// Returns whether the samples of that side (2^j+1), glued along the seams and split as rim_split says, are an indexed
// oriented 2-manifold whatever the positions: no triangle has a vertex twice, no two edges have the same two vertices.
// O(paths log paths).
bool level_is_closed(const SeamTable& table, uint32_t side);

// The number of distinct surface points on the ring at that side, where the level must be closed. O(paths).
uint32_t ring_class_count(const SeamTable& table, uint32_t side);

// Fills class_of[k] for every ring sample k. Samples of one surface point have equal numbers: 0, 1, .. by first
// appearance along the ring. class_of.size() == ring_length(side); (side-1) must be a multiple of (node_side-1).
// O(side).
void ring_classes(const SeamTable& table, uint32_t side, std::span<uint32_t> class_of);

// The split of a cell that touches the rim. class_at(ring index) returns anything comparable that tells classes apart.
template <class ClassAt>
Split rim_split(uint32_t side, uint32_t row, uint32_t column, const ClassAt& class_at);

// ---- implementation of the template ----

// Returns whether the diagonal from rim sample b to interior sample p may double another edge. It may if another of p's
// eight neighbours is the same surface point as b. Those on the rim are a run of the ring: three samples, or five
// around a corner of the square. The side is 5 or more.
template <class ClassAt>
bool diagonal_may_double(uint32_t side, GridPoint b, GridPoint p, const ClassAt& class_at) {
    const uint32_t ring = ring_length(side), of_b = ring_index(side, b.row, b.column);
    const auto outwards = [side](uint32_t x) { return x == 1 ? 0 : x == side - 2 ? side - 1 : x; };
    const GridPoint middle{outwards(p.row), outwards(p.column)};
    const uint32_t reach = middle.row != p.row && middle.column != p.column ? 2 : 1;
    const uint32_t first = ring_index(side, middle.row, middle.column) + ring - reach;
    const auto class_of_b = class_at(of_b);
    for (uint32_t i = 0; i <= 2 * reach; ++i) {
        const uint32_t k = first + i >= ring ? first + i - ring : first + i;
        if (k != of_b && class_at(k) == class_of_b) return true;
    }
    return false;
}

template <class ClassAt>
Split rim_split(uint32_t side, uint32_t row, uint32_t column, const ClassAt& class_at) {
    const uint32_t last_cell = side - 2;
    const bool row_end = row == 0 || row == last_cell;
    const bool column_end = column == 0 || column == last_cell;
    // The split goes through the corner of the square: the other diagonal would join two rim samples.
    if (row_end && column_end) return (row == 0) == (column == 0) ? Split::kMain : Split::kAnti;
    if (!row_end && !column_end) return Split::kShorter;

    const GridPoint a{row, column}, b{row, column + 1}, c{row + 1, column}, d{row + 1, column + 1};
    const bool a_on_rim = on_rim(side, a.row, a.column);
    const bool b_on_rim = on_rim(side, b.row, b.column);
    const bool main_doubles =
        a_on_rim ? diagonal_may_double(side, a, d, class_at) : diagonal_may_double(side, d, a, class_at);
    const bool anti_doubles =
        b_on_rim ? diagonal_may_double(side, b, c, class_at) : diagonal_may_double(side, c, b, class_at);
    if (main_doubles && anti_doubles) return Split::kNever;
    if (main_doubles) return Split::kAnti;
    if (anti_doubles) return Split::kMain;
    return Split::kShorter;
}

}  // namespace gim
