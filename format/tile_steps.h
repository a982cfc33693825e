// Which samples a lifting step on a complex of tiles changes, and by which. spec/gim-format.md, "Tiles".
// One traversal serves all wavelets: samples are numbers of four bytes, and the arithmetic is behind pointers.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/lift_number.h"
#include "format/quad_complex.h"
#include "format/tile_planes.h"

namespace gim {

// Triples along an edge that are lifted from triples beside them. Offsets in numbers.
struct EdgeRun {
    Run target, copy, a, b;  // copy: the same samples in the other tile
    bool has_copy;
    uint32_t count;

    static Run from(Run run, ptrdiff_t tile, uint32_t first, bool backwards = false) {
        return {tile + run.at(first), backwards ? -run.stride : run.stride};
    }
};

// Rows of numbers that are lifted from rows beside them. Offsets and strides in numbers.
struct RowBlock {
    Run target, a, b;
    size_t count;  // of numbers in a row
    uint32_t rows;
};

// The arithmetic of a wavelet.
struct TileArithmetic {
    int steps;             // high from low and low from high, in turn
    const float* factors;  // of each step; nullptr for integers
    float low_gain;        // of low samples within a step
    void (*rows)(const LiftStep& step, void* samples, const RowBlock& block);
    void (*run)(const LiftStep& step, void* samples, const EdgeRun& run);
    // Low samples of vertices from the details around. sums: work space, 6 for each vertex.
    void (*vertices)(const LiftStep& step, const QuadComplex& complex, const TilePlanes& planes, void* samples,
                     void* sums);

    bool is_integer() const { return !factors; }
    LiftStep step(int number, bool undo) const { return {number, is_integer() ? 0 : factors[number], undo}; }
};
extern const TileArithmetic kTiles53, kTiles97, kTilesSharp;

// One wavelet step on all tiles, in place: complex.tiles times planes.size() samples. sums: 6 * complex.vertices sums.
class TileSteps {
  public:
    TileSteps(const TileArithmetic& arithmetic, const QuadComplex& complex, const TilePlanes& planes, void* samples,
              void* sums)
        : arithmetic_(arithmetic), complex_(complex), planes_(planes), samples_(samples), sums_(sums) {}

    // From low samples and details to samples. Details on the borders of tiles are read from the lower half-edge of
    // their edge; low samples must be equal.
    void synthesize();
    // The inverse. Leaves equal samples equal.
    void analyse();

  private:
    // The two sides of an edge. On a boundary both are the only one.
    struct Edge {
        const TileSide &side, &mate_side;
        ptrdiff_t tile, mate;  // where their samples begin
        bool has_mate;
    };

    ptrdiff_t tile(uint32_t t) const { return static_cast<ptrdiff_t>(t * planes_.size()); }
    template <class F>
    void for_each_edge(const F& f);
    void share_details();
    void predict(const LiftStep& step);
    void update(const LiftStep& step);
    void update_inside(const LiftStep& step, ptrdiff_t tile);
    void update_edge(const LiftStep& step, const Edge& edge);

    const TileArithmetic& arithmetic_;
    const QuadComplex& complex_;
    const TilePlanes& planes_;
    void *samples_, *sums_;
};

}  // namespace gim
