// The frames of details on a complex of tiles: as on a square (format/detail_frame.h). The tangents of a detail on an edge
// reach into the tiles at both sides.  spec/gim-format.md, "Tiles".
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/detail_frame.h"
#include "format/quad_complex.h"
#include "format/tile_planes.h"

namespace gim {

class TileFrames {
  public:
    // samples: complex.tiles times planes.size(), with the small images.
    TileFrames(const QuadComplex& complex, const TilePlanes& planes, const float* samples)
        : complex_(complex), planes_(planes), samples_(samples) {}

    // The frame of a detail.
    DetailFrame at(uint32_t tile, Orientation orientation, uint32_t row, uint32_t column, float cell_area) const {
        DetailLanes<1> one;
        find_tangents(tile, orientation, row, column, one, 0);
        make_frames(one, 1, cell_area);
        return frame_of(one);
    }

    // Sets the tangents of a detail as lane i. A detail on the border of the tile must be that of the lower half-edge.
    template <size_t N>
    void find_tangents(uint32_t tile, Orientation orientation, uint32_t row, uint32_t column, DetailLanes<N>& lanes,
                       size_t i) const {
        const uint32_t h = planes_.h;
        if (orientation == Orientation::kHorizontal) {
            if (row == 0) return find_on_side(4 * tile, column, lanes, i);
            if (row == h) return find_on_side(4 * tile + 2, h - 1 - column, lanes, i);
        }
        if (orientation == Orientation::kVertical) {
            if (column == 0) return find_on_side(4 * tile + 3, h - 1 - row, lanes, i);
            if (column == h) return find_on_side(4 * tile + 1, row, lanes, i);
        }
        const ptrdiff_t one = 3, line = 3 * static_cast<ptrdiff_t>(h + 1);
        const float* here = tile_of_samples(tile) + row * line + column * one;
        auto &u = lanes.u, &v = lanes.v;
        for (size_t k = 0; k < 3; ++k, ++here) {
            const float *right = here + one, *below = here + line;
            if (orientation == Orientation::kHorizontal) {
                u[k][i] = right[0] - here[0];
                v[k][i] = 0.25f * ((below[0] - *(here - line)) + (right[line] - *(right - line)));
            } else if (orientation == Orientation::kVertical) {
                u[k][i] = 0.25f * ((right[0] - *(here - one)) + (below[one] - *(below - one)));
                v[k][i] = below[0] - here[0];
            } else {
                u[k][i] = 0.5f * ((right[0] - here[0]) + (below[one] - below[0]));
                v[k][i] = 0.5f * ((below[0] - here[0]) + (below[one] - right[0]));
            }
        }
    }

  private:
    const float* tile_of_samples(uint32_t tile) const { return samples_ + tile * planes_.size(); }

    // The detail at place t of a half-edge. Its row or column is the side of the tile.
    template <size_t N>
    void find_on_side(uint32_t half_edge, uint32_t t, DetailLanes<N>& lanes, size_t i) const {
        const uint32_t mate = complex_.mate[half_edge], s = side_of(half_edge);
        const TileSide& side = planes_.sides[s];
        const float* own = tile_of_samples(tile_of(half_edge));
        const float *start = own + side.low.at(t), *end = own + side.low.at(t + 1);
        const float *start_in = own + side.inner.at(t), *end_in = own + side.inner.at(t + 1);
        const float *start_out = start, *end_out = end;
        if (mate != kNoMate) {
            const float* other = tile_of_samples(tile_of(mate));
            const Run& inner = planes_.sides[side_of(mate)].inner;
            start_out = other + inner.at(planes_.h - t);
            end_out = other + inner.at(planes_.h - 1 - t);
        }
        const float weight = mate != kNoMate ? 0.25f : 0.5f;
        for (size_t k = 0; k < 3; ++k) {
            const float along = end[k] - start[k];
            const float inwards = weight * ((start_in[k] - start_out[k]) + (end_in[k] - end_out[k]));
            lanes.u[k][i] = s == 0 ? along : s == 1 ? -inwards : s == 2 ? -along : inwards;
            lanes.v[k][i] = s == 0 ? inwards : s == 1 ? along : s == 2 ? -inwards : -along;
        }
    }

    const QuadComplex& complex_;
    const TilePlanes& planes_;
    const float* samples_;
};

}  // namespace gim
