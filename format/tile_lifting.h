// The wavelets of squares on a complex of tiles. spec/gim-format.md, "Tiles".
//
// Inside a tile each lifting step runs along rows and along columns, as on a square. Each step looks at direct neighbours
// only. So a step goes on across the border of a tile, and around a vertex of any valence: there a low sample gets what
// it would get from four tiles, times valence / 4. At a boundary the surface is mirrored.
// After: Daubechies, Sweldens (format/lifting.h); Bertram, Duchaineau, Hamann, Joy. Generalized B-Spline Subdivision-
// Surface Wavelets for Geometry Compression. 2004 (lifting around vertices of any valence).
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "format/lifting.h"
#include "format/quad_complex.h"
#include "format/tile_planes.h"

namespace gim {

// What a wavelet adds to a low sample at a vertex. edges, faces: the sums of the details beside it; n: its valence.
struct Tiles53 : Reversible53 {
    using Sum = int64_t;
    template <Direction D>
    static Sample lift_vertex(int, Sample x, Sum edges, Sum faces, uint32_t n) {
        const int64_t divisor = 4 * int64_t{n}, sum = 4 * edges + faces + 2 * int64_t{n};
        const int64_t change = sum / divisor - (sum % divisor < 0);  // rounds down
        const auto u = static_cast<uint32_t>(change);
        return static_cast<int32_t>(static_cast<uint32_t>(x) + (D == Direction::kAnalysis ? u : 0u - u));
    }
};

template <class Base>
struct FloatTiles : Base {
    using Sum = float;
    template <Direction D>
    static float lift_vertex(int step, float x, float edges, float faces, uint32_t n) {
        const float b = Base::kFactor[static_cast<size_t>(step)];
        const float change = (b * edges + (b * b) * faces) * (4.0f / static_cast<float>(n));
        return D == Direction::kAnalysis ? x + change : x - change;
    }
};
using Tiles97 = FloatTiles<Irreversible97>;

// 5/3 on binary32. It predicts a detail from its two neighbours alone, so that creases do not ring.
struct Irreversible53 {
    using Sample = float;
    static constexpr int kSteps = 2;
    static constexpr std::array<float, 2> kFactor = {-0.5f, 0.25f};
    static constexpr float kLowGain = 1;

    template <Direction D>
    static Sample lift(int step, Sample x, Sample a, Sample b) {
        const float change = kFactor[static_cast<size_t>(step)] * (a + b);
        return D == Direction::kAnalysis ? x + change : x - change;
    }
};
using TilesSharp = FloatTiles<Irreversible53>;

// One wavelet step on all tiles, in place: complex.tiles times planes.size() samples. sums: 6 * complex.vertices sums.
template <class Wavelet>
class TileLifting {
  public:
    using Sample = typename Wavelet::Sample;
    using Sum = typename Wavelet::Sum;

    TileLifting(const QuadComplex& complex, const TilePlanes& planes, Sample* samples, Sum* sums)
        : complex_(complex), planes_(planes), samples_(samples), sums_(sums) {}

    // From low samples and details to samples. Details on the borders of tiles are read from the lower half-edge of
    // their edge; low samples must be equal.
    void synthesize() {
        share_details();
        for (int step = Wavelet::kSteps - 1; step > 0; step -= 2) {
            for_each_tile([&](Sample* tile) { update_inside<Direction::kSynthesis>(step, tile); });
            for_each_edge([&](const Edge& e) {
                update_along<Direction::kSynthesis>(step, e);
                update_details<Direction::kSynthesis>(step, e);
                update_across<Direction::kSynthesis>(step, e);
            });
            update_vertices<Direction::kSynthesis>(step);
            for_each_tile([&](Sample* tile) { predict<Direction::kSynthesis>(step - 1, tile); });
        }
    }

    // The inverse. Leaves equal samples equal.
    void analyse() {
        for (int step = 0; step < Wavelet::kSteps; step += 2) {
            for_each_tile([&](Sample* tile) { predict<Direction::kAnalysis>(step, tile); });
            update_vertices<Direction::kAnalysis>(step + 1);
            for_each_edge([&](const Edge& e) {
                update_across<Direction::kAnalysis>(step + 1, e);
                update_details<Direction::kAnalysis>(step + 1, e);
                update_along<Direction::kAnalysis>(step + 1, e);
            });
            for_each_tile([&](Sample* tile) { update_inside<Direction::kAnalysis>(step + 1, tile); });
        }
    }

  private:
    // The two sides of an edge. On a boundary both are the only one.
    struct Edge {
        const TileSide &side, &mate_side;
        Sample *tile, *mate;
        bool has_mate;
    };

    Sample* tile(uint32_t t) const { return samples_ + t * planes_.size(); }

    template <class F>
    void for_each_tile(const F& f) {
        for (uint32_t t = 0; t < complex_.tiles; ++t) f(tile(t));
    }
    template <class F>
    void for_each_edge(const F& f) {
        for (uint32_t e = 0; e < complex_.edges; ++e) {
            const uint32_t h = complex_.lower[e], mate = complex_.mate[h];
            const uint32_t other = mate == kNoMate ? h : mate;
            f(Edge{planes_.sides[side_of(h)], planes_.sides[side_of(other)], tile(tile_of(h)), tile(tile_of(other)),
                   mate != kNoMate});
        }
    }

    void share_details() {
        for_each_edge([&](const Edge& e) {
            if (!e.has_mate) return;
            for (uint32_t i = 0; i < planes_.h; ++i)
                std::copy_n(e.tile + e.side.high.at(i), 3, e.mate + e.mate_side.high.at(planes_.h - 1 - i));
        });
    }

    template <Direction D>
    static void lift_rows(int step, Sample* target, const Sample* a, const Sample* b, size_t count) {
        if (count > 0) lift_row<Wavelet, D>(step, target, a, b, count);
    }

    // Details from low samples, borders included. Both tiles of an edge compute the same bits there.
    template <Direction D>
    void predict(int step, Sample* tile) const {
        const uint32_t h = planes_.h;
        const size_t row = 3 * size_t{h}, low_row = row + 3;
        Sample *low = tile, *horizontal = tile + planes_.horizontal(), *vertical = tile + planes_.vertical(),
               *diagonal = tile + planes_.diagonal();
        const auto faces_from_horizontal = [&] {
            for (uint32_t r = 0; r < h; ++r)
                lift_rows<D>(step, diagonal + r * row, horizontal + r * row, horizontal + (r + 1) * row, row);
        };
        const auto faces_from_vertical = [&] {
            for (uint32_t r = 0; r < h; ++r)
                lift_rows<D>(step, diagonal + r * row, vertical + r * low_row, vertical + r * low_row + 3, row);
        };
        if constexpr (D == Direction::kAnalysis)
            faces_from_horizontal();
        else
            faces_from_vertical();
        for (uint32_t r = 0; r <= h; ++r)
            lift_rows<D>(step, horizontal + r * row, low + r * low_row, low + r * low_row + 3, row);
        for (uint32_t r = 0; r < h; ++r)
            lift_rows<D>(step, vertical + r * low_row, low + r * low_row, low + (r + 1) * low_row, low_row);
        if constexpr (D == Direction::kAnalysis)
            faces_from_vertical();
        else
            faces_from_horizontal();
    }

    // Low samples and details from details, inside a tile.
    template <Direction D>
    void update_inside(int step, Sample* tile) const {
        const uint32_t h = planes_.h;
        const size_t row = 3 * size_t{h}, low_row = row + 3, inside = row - 3;
        Sample *low = tile, *horizontal = tile + planes_.horizontal(), *vertical = tile + planes_.vertical(),
               *diagonal = tile + planes_.diagonal();
        const auto along_rows = [&](uint32_t r) {
            Sample* d = diagonal + r * row;
            lift_rows<D>(step, vertical + r * low_row + 3, d, d + 3, inside);
        };
        const auto low_along_rows = [&](uint32_t r) {
            Sample* z = horizontal + r * row;
            lift_rows<D>(step, low + r * low_row + 3, z, z + 3, inside);
        };
        const auto along_columns = [&](uint32_t r) {
            lift_rows<D>(step, horizontal + r * row, diagonal + (r - 1) * row, diagonal + r * row, row);
        };
        const auto low_along_columns = [&](uint32_t r) {
            lift_rows<D>(step, low + r * low_row + 3, vertical + (r - 1) * low_row + 3, vertical + r * low_row + 3,
                         inside);
        };
        if constexpr (D == Direction::kSynthesis) {
            for (uint32_t r = 0; r < h; ++r) along_rows(r);
            for (uint32_t r = 1; r < h; ++r) low_along_rows(r);
            for (uint32_t r = 1; r < h; ++r) along_columns(r);
            for (uint32_t r = 1; r < h; ++r) low_along_columns(r);
        } else {
            for (uint32_t r = 1; r < h; ++r) low_along_columns(r);
            for (uint32_t r = 1; r < h; ++r) along_columns(r);
            for (uint32_t r = 1; r < h; ++r) low_along_rows(r);
            for (uint32_t r = 0; r < h; ++r) along_rows(r);
        }
    }

    // Sets a sample of an edge in both of its tiles.
    template <class Lift>
    void lift_shared(const Edge& e, Sample* own, Sample* shared, const Lift& lift) const {
        for (size_t k = 0; k < 3; ++k) {
            own[k] = lift(own[k], k);
            if (e.has_mate) shared[k] = own[k];
        }
    }

    // Low samples of an edge from its details.
    template <Direction D>
    void update_along(int step, const Edge& e) const {
        for (uint32_t i = 1; i < planes_.h; ++i) {
            const Sample *before = e.tile + e.side.high.at(i - 1), *after = e.tile + e.side.high.at(i);
            lift_shared(e, e.tile + e.side.low.at(i), e.mate + e.mate_side.low.at(planes_.h - i),
                        [&](Sample x, size_t k) { return Wavelet::template lift<D>(step, x, before[k], after[k]); });
        }
    }
    // Details of an edge from those of the cells at both sides.
    template <Direction D>
    void update_details(int step, const Edge& e) const {
        for (uint32_t i = 0; i < planes_.h; ++i) {
            const uint32_t back = planes_.h - 1 - i;
            const Sample *left = e.tile + e.side.faces.at(i),
                         *right = e.mate + e.mate_side.faces.at(e.has_mate ? back : i);
            lift_shared(e, e.tile + e.side.high.at(i), e.mate + e.mate_side.high.at(back),
                        [&](Sample x, size_t k) { return Wavelet::template lift<D>(step, x, left[k], right[k]); });
        }
    }
    // Low samples of an edge from the details at both sides.
    template <Direction D>
    void update_across(int step, const Edge& e) const {
        for (uint32_t i = 1; i < planes_.h; ++i) {
            const uint32_t back = planes_.h - i;
            const Sample *left = e.tile + e.side.across.at(i),
                         *right = e.mate + e.mate_side.across.at(e.has_mate ? back : i);
            lift_shared(e, e.tile + e.side.low.at(i), e.mate + e.mate_side.low.at(back),
                        [&](Sample x, size_t k) { return Wavelet::template lift<D>(step, x, left[k], right[k]); });
        }
    }

    // Low samples of vertices from the details around. What is added depends on the order of half-edges alone.
    template <Direction D>
    void update_vertices(int step) {
        std::fill_n(sums_, 6 * size_t{complex_.vertices}, Sum{0});
        for (uint32_t h = 0; h < complex_.half_edges(); ++h) {
            const uint32_t v = complex_.vertex[h], before = previous_side(h);
            const Sample* own = tile(tile_of(h));
            const TileSide& side = planes_.sides[side_of(h)];
            Sum* sum = sums_ + 6 * size_t{v};
            const bool mirrored = complex_.on_boundary[v];
            add(own + side.high.at(0), mirrored && complex_.mate[h] != kNoMate, sum);
            if (complex_.mate[before] == kNoMate)
                add(own + planes_.sides[side_of(before)].high.at(planes_.h - 1), false, sum);
            add(own + side.faces.at(0), mirrored, sum + 3);
        }
        for (uint32_t h = 0; h < complex_.half_edges(); ++h) {
            const uint32_t v = complex_.vertex[h];
            const Sum* sum = sums_ + 6 * size_t{v};
            const uint32_t n = complex_.valence[v] * (complex_.on_boundary[v] ? 2 : 1);
            Sample* low = tile(tile_of(h)) + planes_.sides[side_of(h)].low.at(0);
            for (size_t k = 0; k < 3; ++k)
                low[k] = Wavelet::template lift_vertex<D>(step, low[k], sum[k], sum[3 + k], n);
        }
    }
    static void add(const Sample* detail, bool twice, Sum* sum) {
        for (size_t k = 0; k < 3; ++k) {
            const auto value = static_cast<Sum>(detail[k]);
            sum[k] += twice ? value + value : value;
        }
    }

    const QuadComplex& complex_;
    const TilePlanes& planes_;
    Sample* samples_;
    Sum* sums_;
};

// Interleaves the planes of a tile into a grid of (2h+1) x (2h+1) samples, or back.
template <class Sample>
void join_planes(const TilePlanes& planes, const Sample* tile, Sample* grid) {
    const size_t h = planes.h, row = 3 * h, low_row = row + 3, width = 3 * (2 * h + 1);
    const auto interleave = [&](const Sample* low, const Sample* high, Sample* to) {
        for (size_t i = 0; i < h; ++i) {
            std::copy_n(low + 3 * i, 3, to + 6 * i);
            std::copy_n(high + 3 * i, 3, to + 6 * i + 3);
        }
        std::copy_n(low + row, 3, to + 2 * row);
    };
    for (size_t r = 0; r <= h; ++r) {
        interleave(tile + r * low_row, tile + planes.horizontal() + r * row, grid + 2 * r * width);
        if (r < h)
            interleave(tile + planes.vertical() + r * low_row, tile + planes.diagonal() + r * row,
                       grid + (2 * r + 1) * width);
    }
}
template <class Sample>
void split_planes(const TilePlanes& planes, const Sample* grid, Sample* tile) {
    const size_t h = planes.h, row = 3 * h, low_row = row + 3, width = 3 * (2 * h + 1);
    const auto split = [&](const Sample* from, Sample* low, Sample* high) {
        for (size_t i = 0; i < h; ++i) {
            std::copy_n(from + 6 * i, 3, low + 3 * i);
            std::copy_n(from + 6 * i + 3, 3, high + 3 * i);
        }
        std::copy_n(from + 2 * row, 3, low + row);
    };
    for (size_t r = 0; r <= h; ++r) {
        split(grid + 2 * r * width, tile + r * low_row, tile + planes.horizontal() + r * row);
        if (r < h)
            split(grid + (2 * r + 1) * width, tile + planes.vertical() + r * low_row,
                  tile + planes.diagonal() + r * row);
    }
}

}  // namespace gim
