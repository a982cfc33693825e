// Triangles and normals of a fused image.  spec/gim-format.md, "Surface".
// After: Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 4 (shorter diagonal). Along the rim the diagonals
// are chosen so that the glued mesh has no double edge (format/seam.h).
#pragma once

#include <cstdint>

namespace gim {

// The vertices of the closed mesh: first the ring's classes, then the inner samples row by row.
struct VertexNumbers {
    uint32_t side = 0;
    const uint32_t* class_of = nullptr;  // per ring sample; nullptr: every sample is a vertex, in row-major order
    uint32_t class_count = 0;

    uint32_t vertex_count() const { return class_of ? class_count + (side - 2) * (side - 2) : side * side; }
    uint32_t at(uint32_t row, uint32_t column) const;
};

// Work space of triangulate.
struct TriangulateWork {
    float* rows = nullptr;        // 6 * side
    uint32_t* is_main = nullptr;  // side - 1
};

// Writes 2*(side-1)^2 triangles, cell by cell, counter-clockwise from outside. class_of decides the splits along the
// rim, whatever the numbering.
void triangulate(const float* samples, uint32_t side, const uint32_t* class_of, const VertexNumbers& numbers,
                 const TriangulateWork& work, uint32_t* triangles);

// Computes unit normals of all side*side samples: cross products of the central differences (one-sided on the rim),
// summed over glued samples; zero if the sum is. sums: work space for 3*class_count numbers.
void sample_normals(const float* samples, uint32_t side, const uint32_t* class_of, uint32_t class_count, float* sums,
                    float* normals);

}  // namespace gim
