// Solves symmetric positive definite systems on a grid: one 3-vector of unknowns per sample, symmetric 3 x 3 blocks to
// the eight neighbours. Some samples are glued into one unknown. The method is conjugate gradients with a 3 x 3 block
// Jacobi preconditioner, in floats. Each component has its own array, so that loops over a row vectorise.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/image/gluing.h"
#include "encoder/surface/mesh.h"

namespace gim {

// xx, xy, xz, yy, yz, zz.
using SymmetricBlock = std::array<float, 6>;

// One array per component.
using Channels = std::array<std::vector<float>, 3>;

class StencilMatrix {
  public:
    StencilMatrix(uint32_t width, uint32_t height) : width_(width), height_(height) {
        for (auto& channels : block_) {
            for (auto& channel : channels) channel.assign(size_t{width} * height, 0.0f);
        }
    }

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

    // Adds a block between two neighbours, or between a sample and itself.
    void add(uint32_t i, uint32_t j, const SymmetricBlock& block, float factor) {
        if (i > j) std::swap(i, j);
        const uint32_t offset = j - i;
        const size_t kind = offset == 0        ? kDiagonal
                            : offset == 1      ? kEast
                            : offset == width_ ? kSouth
                            : offset > width_  ? kSouthEast
                                               : kSouthWest;
        for (size_t k = 0; k < 6; ++k) block_[kind][k][i] += factor * block[k];
    }

    // Computes out = matrix * in, in parallel. Each sample is an unknown of its own.
    void multiply(const Channels& in, Channels& out) const;

    enum Kind : size_t { kDiagonal, kEast, kSouth, kSouthEast, kSouthWest, kKinds };
    const float* channel(Kind kind, size_t k) const { return block_[kind][k].data(); }

  private:
    void accumulate(Kind kind, size_t begin, size_t end, ptrdiff_t block_shift, ptrdiff_t shift, const Channels& in,
                    Channels& out) const;

    uint32_t width_, height_;
    std::array<std::array<std::vector<float>, 6>, kKinds> block_;
};

struct SolverOptions {
    uint32_t most_steps = 60;
    double tolerance = 1e-3;  // of the residual, relative to the right side
};

struct Solution {
    std::vector<Vec3> values;  // per sample; equal within a class
    uint32_t steps = 0;
};

// `right`: per sample; the right side of a glued unknown is the sum over its class. `fixed` and undefined samples get
// the value zero. The grid needs at least three columns. The result has the same bits for any number of threads.
Solution solve(const StencilMatrix& matrix, const std::vector<Vec3>& right, const GridGluing& gluing,
               const std::vector<bool>& fixed, const SolverOptions& options);

}  // namespace gim
