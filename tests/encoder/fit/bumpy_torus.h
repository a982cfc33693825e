// A torus with bumps, and squares that lie on it, for tests of fits to the codec.
#pragma once

#include <cstdint>

#include "corpus/generators.h"
#include "encoder/squares/write_squares.h"
#include "encoder/surface/closest_point.h"
#include "tests/encoder/coding_parameters.h"
#include "tests/encoder/grid_images.h"

namespace gim::test {

inline Mesh bumpy_torus() { return mesh_of(corpus::roughened(corpus::torus(60, 30, 0.7, 0.3), 0.01, 4)); }

// Samples of the smooth torus put onto the surface.
inline SquareImage torus_on(const Mesh& surface, uint32_t side) {
    SquareImage image = torus_image(side, 0.7, 0.3);
    const ClosestPointTree tree(surface);
    for (Vec3& p : image.positions) p = tree.find(p).point;
    return image;
}

inline Units units_for(const SquareImage& image, double quantizer) {
    return squares_writer({&image, 1}, lossy(quantizer)).value().header(quantizer);
}

}  // namespace gim::test
