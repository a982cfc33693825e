#include "decoder/refine/tile_groups.h"

#include <algorithm>

#include "format/quad_complex.h"

namespace gim {
namespace {

constexpr uint32_t kNone = UINT32_MAX, kIsTaken = UINT32_MAX;

}  // namespace

TileGroups::TileGroups(const QuadDomain* domain, uint32_t connected_levels, Arena* arena)
    : domain_(domain), connected_levels_(connected_levels) {
    const uint32_t tiles = domain->shape().tiles;
    uint32_t most = tiles;
    for (uint32_t level = 1; level <= connected_levels || most > 1; ++level) {
        group_[level - 1] = arena->take<uint32_t>(most);
        if (level > connected_levels) most = (most + kMostMembers - 1) / kMostMembers;
        first_[level] = arena->take<uint32_t>(size_t{most} + 1);
    }
    for (uint32_t** array : {&order_, &group_of_tile_, &next_tile_, &first_tile_, &last_tile_, &shared_, &candidates_})
        *array = arena->take<uint32_t>(tiles);
    centers_ = arena->take<Center>(tiles);
}

void TileGroups::run() {
    const uint32_t tiles = domain_->shape().tiles;
    count_[0] = tiles;
    for (uint32_t t = 0; t < tiles; ++t) {
        group_of_tile_[t] = first_tile_[t] = last_tile_[t] = t;
        next_tile_[t] = kNone;
        centers_[t] = {{}, 1};
        for (uint32_t i = 0; i < 4; ++i) {
            const float* corner = domain_->value(domain_->glue().corner[4 * t + i]).position;
            for (int k = 0; k < 3; ++k) centers_[t].sum[k] += 0.25 * static_cast<double>(corner[k]);
        }
    }
    levels_ = 1;
    while (levels_ <= connected_levels_ || count_[levels_ - 1] > 1) group_level(levels_++);
    number_groups();
}

// Most shared sides first, so that four tiles in a square are found; then the nearest.
uint32_t TileGroups::best_candidate(const Center& middle) const {
    uint32_t best = kNone;
    double best_distance = 0;
    for (uint32_t i = 0; i < candidate_count_; ++i) {
        const uint32_t c = candidates_[i];
        if (shared_[c] == kIsTaken) continue;
        double distance = 0;
        for (int k = 0; k < 3; ++k) {
            const double d = centers_[c].sum[k] / centers_[c].weight - middle.sum[k] / middle.weight;
            distance += d * d;
        }
        if (best == kNone || shared_[c] > shared_[best] || (shared_[c] == shared_[best] && distance < best_distance)) {
            best = c;
            best_distance = distance;
        }
    }
    return best;
}

void TileGroups::add_member(uint32_t level, uint32_t member, uint32_t group, Center* middle) {
    group_[level - 1][member] = group;
    shared_[member] = kIsTaken;
    for (int k = 0; k < 3; ++k) middle->sum[k] += centers_[member].sum[k];
    middle->weight += centers_[member].weight;
    for (uint32_t t = first_tile_[member]; t != kNone; t = next_tile_[t]) {
        for (uint32_t side = 4 * t; side < 4 * t + 4; ++side) {
            const uint32_t mate = domain_->glue().mate[side];
            if (mate == kNoMate) continue;
            const uint32_t neighbour = group_of_tile_[tile_of(mate)];
            if (shared_[neighbour] == kIsTaken) continue;
            if (shared_[neighbour]++ == 0) candidates_[candidate_count_++] = neighbour;
        }
    }
}

void TileGroups::group_level(uint32_t level) {
    const uint32_t members = count_[level - 1];
    std::fill_n(shared_, members, 0u);
    uint32_t groups = 0, next = 0;
    for (uint32_t seed = 0; seed < members; ++seed) {
        if (shared_[seed] == kIsTaken) continue;
        Center middle{{}, 0};
        candidate_count_ = 0;
        uint32_t added[kMostMembers], size = 0;
        for (uint32_t member = seed; member != kNone;) {
            add_member(level, member, groups, &middle);
            added[size++] = member;
            if (size == kMostMembers) break;
            member = best_candidate(middle);
            if (member != kNone || level <= connected_levels_) continue;
            while (next < members && shared_[next] == kIsTaken) ++next;
            member = next < members ? next : kNone;
        }
        for (uint32_t i = 0; i < candidate_count_; ++i) {
            if (shared_[candidates_[i]] != kIsTaken) shared_[candidates_[i]] = 0;
        }
        // The group's tiles and centre, in place of those of a member that is done: groups <= seed.
        const uint32_t first = first_tile_[added[0]];
        for (uint32_t i = 1; i < size; ++i) next_tile_[last_tile_[added[i - 1]]] = first_tile_[added[i]];
        const uint32_t last = last_tile_[added[size - 1]];
        first_tile_[groups] = first;
        last_tile_[groups] = last;
        centers_[groups++] = middle;
    }
    for (uint32_t t = 0; t < domain_->shape().tiles; ++t) group_of_tile_[t] = group_[level - 1][group_of_tile_[t]];
    count_[level] = groups;
}

// From the top down, so that the members of each group follow each other. group_ then has the new number of each group.
void TileGroups::number_groups() {
    const uint32_t top = levels_ - 1;
    const uint32_t* number = nullptr;  // of the groups of the level above
    for (uint32_t level = top; level > 0; --level) {
        uint32_t* const first = first_[level];
        uint32_t* const group = group_[level - 1];
        std::fill_n(first, count_[level] + 1, 0u);
        for (uint32_t i = 0; i < count_[level - 1]; ++i) {
            if (number) group[i] = number[group[i]];
            ++first[group[i] + 1];
        }
        for (uint32_t g = 0; g < count_[level]; ++g) first[g + 1] += first[g];
        for (uint32_t i = 0; i < count_[level - 1]; ++i) group[i] = first[group[i]]++;
        for (uint32_t g = count_[level]; g > 0; --g) first[g] = first[g - 1];
        first[0] = 0;
        number = group;
    }
    for (uint32_t t = 0; t < count_[0]; ++t) order_[number ? number[t] : t] = t;
}

}  // namespace gim
