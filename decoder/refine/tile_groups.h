// Tiles in groups, groups in groups, and so on to one: up to four each time, neighbours together.
#pragma once

#include <cstdint>

#include "decoder/pyramid/arena.h"
#include "decoder/refine/quad_domain.h"

namespace gim {

// Level 0 has each tile alone. A group of level l has up to four of level l - 1. Up to a level that is asked for, groups are
// connected; above, they take what is left, so that each level has a quarter of the one before.
class TileGroups {
  public:
    static constexpr uint32_t kMostMembers = 4, kMostLevels = 32;

    // Takes its arrays from the arena. Without memory it only counts.
    TileGroups(const QuadDomain* domain, uint32_t connected_levels, Arena* arena);

    // Cost: O(tiles * levels).
    void run();

    uint32_t levels() const { return levels_; }  // the last one has one group, unless it is a connected one
    uint32_t count(uint32_t level) const { return count_[level]; }
    // Groups are numbered so that members follow each other: group i of `level` has those from first_member(level, i) to
    // first_member(level, i + 1) of the level below.
    uint32_t first_member(uint32_t level, uint32_t group) const { return first_[level][group]; }
    // As places in the order of tiles.
    uint32_t first_tile(uint32_t level, uint32_t group) const {
        for (; level > 0; --level) group = first_[level][group];
        return group;
    }
    uint32_t tile(uint32_t place) const { return order_[place]; }

  private:
    struct Center {
        double sum[3];
        double weight;
    };

    void group_level(uint32_t level);
    uint32_t best_candidate(const Center& middle) const;
    void add_member(uint32_t level, uint32_t member, uint32_t group, Center* middle);
    void number_groups();

    const QuadDomain* domain_;
    uint32_t connected_levels_, levels_ = 1;
    uint32_t count_[kMostLevels] = {};
    uint32_t* group_[kMostLevels] = {};  // per group of a level: the one of the next level that has it
    uint32_t* first_[kMostLevels] = {};  // per group and one more: the first member
    uint32_t* order_;
    // While a level is made. Per tile: its group one level below, and the next tile of that one.
    uint32_t *group_of_tile_, *next_tile_;
    uint32_t *first_tile_, *last_tile_, *shared_, *candidates_;  // per group
    Center* centers_;
    uint32_t candidate_count_ = 0;
};

}  // namespace gim
