#include "encoder/tiles/tile_walk.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "encoder/surface/stretch.h"

namespace gim {

namespace {

constexpr int kMostSteps = 1024;

// Returns the side through which the way from -> to leaves the unit square, or kNone if that is uncertain.
// Side i runs from corner i to corner i + 1.
uint32_t exit_side(const Vec2& from, const Vec2& to) {
    const std::array<bool, 4> beyond{to.y() < 0, to.x() > 1, to.y() > 1, to.x() < 0};
    for (uint32_t i = 0; i < 4; ++i) {
        const uint32_t after = (i + 1) % 4;
        if (!beyond[i] || !beyond[after]) continue;
        const Vec2 way = to - from, corner = TileWalker::corner(after) - from;
        const double side = cross(way, corner);
        if (std::abs(side) <= 1e-12 * (std::abs(way.x() * corner.y()) + std::abs(way.y() * corner.x()))) return kNone;
        return side > 0 ? i : after;
    }
    return static_cast<uint32_t>(std::find(beyond.begin(), beyond.end(), true) - beyond.begin());
}

// Returns the half-edge on the boundary that begins where h, on the boundary too, ends.
uint32_t next_on_boundary(const QuadComplex& complex, uint32_t h) {
    uint32_t after = next_side(h);
    while (complex.mate[after] != kNoMate) after = next_side(complex.mate[after]);
    return after;
}

}  // namespace

TileWalker TileWalker::with_fringe(const QuadComplex& complex) {
    std::vector<uint32_t> mates(complex.mate, complex.mate + complex.half_edges());
    std::vector<uint32_t> fringe(mates.size(), kNoMate);  // per half-edge: side 0 of the tile beyond it
    for (uint32_t h = 0; h < fringe.size(); ++h) {
        if (complex.mate[h] != kNoMate) continue;
        fringe[h] = mates[h] = static_cast<uint32_t>(mates.size());
        mates.insert(mates.end(), {h, kNoMate, kNoMate, kNoMate});
    }
    for (uint32_t h = 0; h < fringe.size(); ++h) {
        if (fringe[h] == kNoMate) continue;
        const uint32_t here = fringe[h] + 3, there = fringe[next_on_boundary(complex, h)] + 1;
        mates[here] = there;
        mates[there] = here;
    }
    TileWalker walker(std::move(mates));
    walker.inner_ = complex.tiles;
    return walker;
}

std::optional<TileFrame> TileWalker::walk(uint32_t tile, const Vec2& from, const Vec2& to) const {
    TileFrame frame{tile, 0, Vec2::Zero()};
    for (int step = 0; step < kMostSteps; ++step) {
        const Vec2 end = frame(to);
        if (in_unit_square(end)) return frame;
        const uint32_t i = exit_side(frame(from), end);
        if (i == kNone) return std::nullopt;
        const uint32_t mate = mates_[4 * frame.tile + i];
        if (mate == kNoMate) return std::nullopt;
        // Corner i here is the corner after j there, and the two sides run against each other.
        const uint32_t j = mate % 4, quarters = (j + 6 - i) % 4;
        frame.shift = turned(frame.shift, quarters) + corner((j + 1) % 4) - turned(corner(i), quarters);
        frame.quarters = (frame.quarters + quarters) % 4;
        frame.tile = mate / 4;
    }
    return std::nullopt;
}

}  // namespace gim
