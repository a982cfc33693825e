// Smoothing groups of OBJ: faces of one group are shaded as one smooth surface, other edges are hard.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/polygons.h"

namespace gim {

// Returns the group that follows "s" in a file; 0 for "off", "0" and what is no number.
uint32_t smoothing_group_named(std::string_view word);

// Gives the soup the normals with which renderers shade groups: those of faces, summed at each vertex over the faces of a
// group. Faces of group 0 keep their own. Adds nothing if all faces have the same group, because programs write that
// without being asked. groups: one per face. Cost: O(corners log corners).
void add_group_normals(const std::vector<uint32_t>& groups, PolygonSoup& soup);

}  // namespace gim
