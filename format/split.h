// How a cell of four samples is cut into two triangles.
#pragma once

#include <cstdint>

namespace gim {

// For the cell whose first sample is (row, column).
enum class Split : uint8_t {
    kShorter,  // along the shorter diagonal; kMain when both are equally long
    kMain,     // (row, column) - (row+1, column+1)
    kAnti,     // (row, column+1) - (row+1, column)
    kNever,    // no split gives a manifold; does not happen at closed levels
};

}  // namespace gim
