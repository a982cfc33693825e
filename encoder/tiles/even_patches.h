// Gives every patch between creases and boundaries an even number of faces, so that its faces can be paired.
#pragma once

#include "encoder/tiles/decimator.h"

namespace gim {

// A collapse along a crease takes a face from the patches on both sides of it, one along a boundary from one patch. So an
// odd patch is joined to another one, or to a boundary, by a chain of such collapses, the cheapest first.
// Returns whether all patches are even. Cost: O(F) a collapse.
bool make_patches_even(Decimator& decimator);

}  // namespace gim
