// Random valid sidebands: polygonal schemas of any genus, with boundaries. They have a generator of their own, so that
// they are the same on every platform.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "format/ring.h"
#include "format/sideband.h"

namespace gim::test {

class Random {
  public:
    explicit Random(uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) {}
    // 0 .. limit-1
    uint32_t below(uint32_t limit) { return static_cast<uint32_t>((uint64_t{next()} * limit) >> 32); }
    float unit() { return static_cast<float>(next() >> 8) * 0x1p-24f; }
    uint32_t next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        uint64_t x = state_ ^ state_ >> 33;
        x *= 0xFF51AFD7ED558CCDu;
        return static_cast<uint32_t>(x >> 32);
    }

  private:
    uint64_t state_;
};

// Puts `pairs` pairs of mates and `open` open paths in random order on the ring of that node grid. nested: mates nest
// like brackets (a tree: genus 0); else any order. Needs 2*pairs + open <= ring length.
inline Sideband random_sideband(Random& random, uint32_t node_side, uint32_t pairs, uint32_t open, bool nested) {
    const uint32_t count = 2 * pairs + open;
    Sideband s;
    s.node_side = node_side;
    s.paths.resize(count);
    std::vector<uint32_t> order(count);
    for (uint32_t i = 0; i < count; ++i) order[i] = i;
    for (uint32_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    for (uint32_t i = 0; i < pairs; ++i) {
        s.paths[order[2 * i]].mate = order[2 * i + 1];
        s.paths[order[2 * i + 1]].mate = order[2 * i];
    }
    if (nested) {
        // Re-pair the mated places as brackets: a random legal sequence.
        std::vector<uint32_t> stack;
        uint32_t opens_left = pairs;
        for (uint32_t i = 0; i < count; ++i) {
            if (s.paths[i].mate == kNoMate) continue;
            if (opens_left > 0 && (stack.empty() || random.below(2) == 0)) {
                stack.push_back(i);
                --opens_left;
            } else {
                s.paths[i].mate = stack.back();
                s.paths[stack.back()].mate = i;
                stack.pop_back();
            }
        }
    }
    // Every path gets one unit. The rest is dealt out at random; a pair takes two units.
    for (CutPath& p : s.paths) p.length = 1;
    uint32_t left = ring_length(node_side) - count;
    while (left > 0) {
        const uint32_t i = random.below(count);
        CutPath& p = s.paths[i];
        const uint32_t amount = 1 + random.below(1 + left / (2 * count));
        if (p.mate == kNoMate) {
            p.length += amount;
            left -= amount;
        } else if (left >= 2 * amount) {
            p.length += amount;
            s.paths[static_cast<size_t>(p.mate)].length += amount;
            left -= 2 * amount;
        } else if (open == 0 && left == 1) {
            break;  // cannot happen: the ring is even
        }
    }
    s.start = random.below(ring_length(node_side));
    return s;
}

}  // namespace gim::test
