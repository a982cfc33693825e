// Walks over the flat surface of the tiles. Every tile is a unit square, so a step into a neighbour is a turn by right
// angles and a shift by integers. Nothing is rounded: all places lie on a fine grid (kGrid).
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/surface/mesh.h"
#include "format/quad_complex.h"

namespace gim {

// Places are multiples of this. Sums and differences of places within 256 tiles are then exact.
inline constexpr double kGrid = 0x1p-44;

// Turns p by right angles, counter-clockwise.
inline Vec2 turned(const Vec2& p, uint32_t quarters) {
    switch (quarters % 4) {
        case 0:
            return p;
        case 1:
            return {-p.y(), p.x()};
        case 2:
            return {-p.x(), -p.y()};
        default:
            return {p.y(), -p.x()};
    }
}

// Returns how many right angles turn `from` into `to`. Both have the same length up to such a turn, and are not zero.
inline uint32_t quarters_between(const Vec2& from, const Vec2& to) {
    if (from == to) return 0;
    if (-from.y() == to.x() && from.x() == to.y()) return 1;
    return -from.x() == to.x() && -from.y() == to.y() ? 2 : 3;
}

// A tile, and the motion from the frame where the walk began into the frame of that tile.
struct TileFrame {
    uint32_t tile = 0;
    uint32_t quarters = 0;
    Vec2 shift = Vec2::Zero();

    Vec2 operator()(const Vec2& p) const { return turned(p, quarters) + shift; }
};

class TileWalker {
  public:
    // mates: per half-edge of the tiles (format/quad_complex.h).
    explicit TileWalker(std::vector<uint32_t> mates) : mates_(std::move(mates)), inner_(mates_.size() / 4) {}
    // Walks over a complex and a fringe: beyond each side on a boundary lies one more tile. Tiles of the fringe are
    // numbered after those of the complex. Neighbours along a boundary are glued to each other.
    static TileWalker with_fringe(const QuadComplex& complex);

    size_t complex_tiles() const { return inner_; }  // those that are not of the fringe
    uint32_t mate(uint32_t half_edge) const { return mates_[half_edge]; }
    // Where the corners of a tile lie in its frame, counter-clockwise.
    static Vec2 corner(uint32_t i) { return {i == 1 || i == 2 ? 1.0 : 0.0, i >= 2 ? 1.0 : 0.0}; }

    // Walks from a point of a tile straight to another point, both in the frame of that tile. Returns the tile of the
    // end. Returns nothing if the way leaves the surface, or passes a corner so closely that its side is uncertain.
    std::optional<TileFrame> walk(uint32_t tile, const Vec2& from, const Vec2& to) const;

  private:
    std::vector<uint32_t> mates_;
    size_t inner_;
};

// Returns whether the closed unit square contains p.
inline bool in_unit_square(const Vec2& p) { return p.x() >= 0 && p.x() <= 1 && p.y() >= 0 && p.y() <= 1; }

}  // namespace gim
