#include "format/seam.h"

#include <algorithm>
#include <bit>

namespace gim {
namespace {

// Identifies a ring sample at some level by a value that is equal exactly for glued samples: a node's class, or the
// pair (first of the two mates, offset along it).
uint64_t glued_identity(const SeamTable& table, uint32_t scale, uint32_t k) {
    const uint32_t start = table.first[0] * scale;
    const uint32_t position = k >= start ? k : k + table.first[table.path_count] * scale - start;
    const uint32_t node_position = position >> std::countr_zero(scale);  // sides are 2^j + 1
    const auto begin = table.first.begin();
    const auto path =
        static_cast<uint32_t>(std::upper_bound(begin, begin + table.path_count, node_position) - begin) - 1;
    const uint32_t offset = position - table.first[path] * scale;
    if (offset == 0) return (uint64_t{1} << 48) | table.node_class[path];
    const uint32_t mate = table.mate[path];
    if (mate == kNoMate || path < mate) return uint64_t{path} << 24 | offset;
    return uint64_t{mate} << 24 | (table.length(path) * scale - offset);
}

uint32_t next_path(const SeamTable& table, uint32_t path) { return path + 1 == table.path_count ? 0 : path + 1; }

uint16_t find_root(std::array<uint16_t, kMaxCutPaths>& parent, uint16_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

// Returns whether two paths of one edge join the same two classes, at the level where node-grid steps are single ring
// edges.
bool has_double_unit_path(const SeamTable& table) {
    std::array<uint32_t, kMaxCutPaths> keys;
    uint32_t count = 0;
    for (uint32_t i = 0; i < table.path_count; ++i) {
        if (table.length(i) != 1) continue;
        if (table.mate[i] != kNoMate && table.mate[i] < i) continue;  // counted with its mate
        const auto [low, high] = std::minmax(table.node_class[i], table.node_class[next_path(table, i)]);
        keys[count++] = uint32_t{low} << 16 | high;
    }
    std::make_heap(keys.begin(), keys.begin() + count);  // a small program: this is rare
    std::sort_heap(keys.begin(), keys.begin() + count);
    return std::adjacent_find(keys.begin(), keys.begin() + count) != keys.begin() + count;
}

// The cell inside the ring edge k, k+1.
GridPoint cell_at_edge(uint32_t side, uint32_t k) {
    const GridPoint a = ring_point(side, k);
    const GridPoint b = ring_point(side, k + 1 == ring_length(side) ? 0 : k + 1);
    return {std::min({a.row, b.row, side - 2}), std::min({a.column, b.column, side - 2})};
}

}  // namespace

Status build_seam_table(uint32_t node_side, uint32_t start, std::span<const CutPath> paths, SeamTable* table) {
    *table = SeamTable();
    if (paths.empty()) return Status::kOk;
    if (!is_grid_side(node_side) || paths.size() > kMaxCutPaths) return Status::kMalformed;
    table->node_side = node_side;
    table->path_count = static_cast<uint32_t>(paths.size());

    // Lengths fill the ring exactly.
    const uint32_t ring = ring_length(node_side);
    if (start >= ring) return Status::kMalformed;
    table->first[0] = start;
    for (uint32_t i = 0; i < paths.size(); ++i) {
        const uint32_t used = table->first[i] - start;
        if (paths[i].length == 0 || paths[i].length > ring - used) return Status::kMalformed;
        table->first[i + 1] = table->first[i] + paths[i].length;
    }
    if (table->first[table->path_count] != start + ring) return Status::kMalformed;

    // Mates are mutual.
    for (uint32_t i = 0; i < paths.size(); ++i) {
        const uint32_t mate = paths[i].mate;
        if (mate == kNoMate) {
            table->mate[i] = kNoMate;
            continue;
        }
        if (mate >= paths.size() || mate == i || paths[mate].mate != i || paths[mate].length != paths[i].length)
            return Status::kMalformed;
        table->mate[i] = mate;
    }

    // A path's first node is its mate's last one, which is the first node of the path after the mate.
    auto& parent = table->node_class;
    for (uint32_t i = 0; i < table->path_count; ++i) parent[i] = static_cast<uint16_t>(i);
    for (uint32_t i = 0; i < table->path_count; ++i) {
        if (table->mate[i] == kNoMate) continue;
        const uint16_t a = find_root(parent, static_cast<uint16_t>(i));
        const uint16_t b = find_root(parent, static_cast<uint16_t>(next_path(*table, table->mate[i])));
        parent[std::max(a, b)] = std::min(a, b);
    }
    // Roots have the smallest index of their class, so a rising pass can number in place.
    std::array<uint16_t, kMaxCutPaths> root;
    for (uint32_t i = 0; i < table->path_count; ++i) root[i] = find_root(parent, static_cast<uint16_t>(i));
    for (uint32_t i = 0; i < table->path_count; ++i) {
        parent[i] = root[i] == i ? static_cast<uint16_t>(table->node_class_count++) : parent[root[i]];
    }
    return Status::kOk;
}

bool level_is_closed(const SeamTable& table, uint32_t side) {
    if (!is_grid_side(side) || side < 3) return false;
    if (table.path_count == 0) return true;
    if (side < table.node_side) return false;
    const uint32_t scale = (side - 1) / (table.node_side - 1);
    const uint32_t ring = ring_length(side);
    const auto identity = [&](uint32_t k) { return glued_identity(table, scale, k); };

    // Ring edges. A sample inside a path meets only its two neighbours along the path, so an edge can have a double (or
    // be a loop) only on a path of one or two edges.
    for (uint32_t i = 0; i < table.path_count; ++i) {
        const bool closed_path = table.node_class[i] == table.node_class[next_path(table, i)];
        if (closed_path && table.length(i) * scale < 3) return false;
    }
    if (scale == 1 && has_double_unit_path(table)) return false;

    // Some edges from the rim to an interior sample are always there. A corner and the ring samples beside it lead to
    // the one interior sample near it. At side 3 the whole ring leads to the centre.
    if (side == 3) {
        for (uint32_t k = 0; k < 8; ++k)
            for (uint32_t other = 0; other < k; ++other)
                if (identity(k) == identity(other)) return false;
        return true;
    }
    for (uint32_t corner = 0; corner < ring; corner += side - 1) {
        if (identity((corner + ring - 1) % ring) == identity(corner + 1)) return false;
    }

    // Every rim cell needs a diagonal that doubles no edge. Away from the corners both double one only if ring edges
    // k-1, k and k+1 are whole paths (then scale is 1). Near the corners each cell is checked.
    const auto cell_is_fine = [&](uint32_t k) {
        const GridPoint cell = cell_at_edge(side, k);
        return rim_split(side, cell.row, cell.column, identity) != Split::kNever;
    };
    for (uint32_t corner = 0; corner < ring; corner += side - 1) {
        for (uint32_t k = 0; k < 6; ++k) {
            if (!cell_is_fine((corner + ring - 3 + k) % ring)) return false;
        }
    }
    if (scale == 1) {
        for (uint32_t i = 0; i < table.path_count; ++i) {
            if (table.length(i) == 1 && !cell_is_fine(table.first[i] % ring)) return false;
        }
    }
    return true;
}

uint32_t ring_class_count(const SeamTable& table, uint32_t side) {
    if (table.path_count == 0) return ring_length(side);
    const uint32_t scale = (side - 1) / (table.node_side - 1);
    uint32_t count = table.node_class_count;
    for (uint32_t i = 0; i < table.path_count; ++i) {
        if (table.mate[i] == kNoMate || i < table.mate[i]) count += table.length(i) * scale - 1;
    }
    return count;
}

void ring_classes(const SeamTable& table, uint32_t side, std::span<uint32_t> class_of) {
    const uint32_t ring = ring_length(side);
    if (table.path_count == 0) {
        for (uint32_t k = 0; k < ring; ++k) class_of[k] = k;
        return;
    }
    const uint32_t scale = (side - 1) / (table.node_side - 1);
    const auto wrap = [ring](uint32_t k) { return k >= ring ? k - ring : k; };

    // First every sample gets the smallest ring index among its equals ...
    std::array<uint32_t, kMaxCutPaths> smallest;
    std::fill_n(smallest.begin(), table.node_class_count, ring);
    for (uint32_t i = 0; i < table.path_count; ++i) {
        uint32_t& s = smallest[table.node_class[i]];
        s = std::min(s, wrap(table.first[i] * scale));
    }
    for (uint32_t i = 0; i < table.path_count; ++i) {
        const uint32_t length = table.length(i) * scale;
        const uint32_t begin = table.first[i] * scale;
        class_of[wrap(begin)] = smallest[table.node_class[i]];
        const uint32_t mate = table.mate[i];
        for (uint32_t t = 1; t < length; ++t) {
            const uint32_t k = wrap(begin + t);
            class_of[k] = mate == kNoMate ? k : std::min(k, wrap(table.first[mate] * scale + length - t));
        }
    }
    // ... then the smallest ones are numbered in ring order; an equal with a smaller index has its number already.
    uint32_t count = 0;
    for (uint32_t k = 0; k < ring; ++k) class_of[k] = class_of[k] == k ? count++ : class_of[class_of[k]];
}

}  // namespace gim
