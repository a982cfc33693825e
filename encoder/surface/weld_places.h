// Numbers the places at which vertices lie, so that vertices at one place have one number.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

using Point = std::array<double, 3>;

inline Vec3 to_vec(const Point& p) { return {p[0], p[1], p[2]}; }

// Equal positions, and only they, share a number: the smallest vertex there. O(V log V).
std::vector<uint32_t> number_places(const std::vector<Point>& positions);

// How finely the coordinates are given. Two binary32 roundings of the largest coordinate if all coordinates are
// binary32 numbers, else two of binary64; but at least a ten-millionth of the bounding box's diagonal. Triangles thinner
// than this are collinear but for rounding.
double resolution_of(const std::vector<Point>& positions);

// Unites the places at the ends of edges that are not longer than `tolerance`. place: as from number_places; changed.
void unite_short_edges(const std::vector<Point>& positions, const std::vector<Triangle>& triangles, double tolerance,
                       std::vector<uint32_t>& place);

// Unites places of `candidates` (vertices) that are not farther apart than `tolerance`. Leaves places alone where a
// chain of them is longer than twice the tolerance. Returns the number of places that are gone. O(V log V).
uint64_t unite_near(const std::vector<Point>& positions, std::span<const uint32_t> candidates, double tolerance,
                    std::vector<uint32_t>& place);

}  // namespace gim
