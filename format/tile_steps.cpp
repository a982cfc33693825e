#include "format/tile_steps.h"

#include <algorithm>
#include <cstring>

#include "format/lift_tiles.h"
#include "format/tile_lifting.h"

namespace gim {
namespace {

// What is added depends on the order of half-edges alone.
template <class Lift>
void lift_vertices(const LiftStep& step, const QuadComplex& complex, const TilePlanes& planes, void* samples,
                   void* sums) {
    using Sum = typename Lift::Sum;
    using Sample = typename Lift::Sample;
    const Lift lift(step);
    auto* sums_of = static_cast<Sum*>(sums);
    const auto tile = [&](uint32_t h) { return static_cast<Sample*>(samples) + tile_of(h) * planes.size(); };
    const auto add = [](const Sample* detail, bool twice, Sum* sum) {
        for (size_t k = 0; k < 3; ++k) {
            const auto value = static_cast<Sum>(detail[k]);
            sum[k] += twice ? value + value : value;
        }
    };
    std::fill_n(sums_of, 6 * size_t{complex.vertices}, Sum{0});
    for (uint32_t h = 0; h < complex.half_edges(); ++h) {
        const uint32_t v = complex.vertex[h], before = previous_side(h);
        const TileSide& side = planes.sides[side_of(h)];
        Sum* sum = sums_of + 6 * size_t{v};
        const bool mirrored = complex.on_boundary[v];
        add(tile(h) + side.high.at(0), mirrored && complex.mate[h] != kNoMate, sum);
        if (complex.mate[before] == kNoMate)
            add(tile(h) + planes.sides[side_of(before)].high.at(planes.h - 1), false, sum);
        add(tile(h) + side.faces.at(0), mirrored, sum + 3);
    }
    for (uint32_t h = 0; h < complex.half_edges(); ++h) {
        const uint32_t v = complex.vertex[h];
        const Sum* sum = sums_of + 6 * size_t{v};
        const uint32_t n = complex.valence[v] * (complex.on_boundary[v] ? 2 : 1);
        Sample* low = tile(h) + planes.sides[side_of(h)].low.at(0);
        for (size_t k = 0; k < 3; ++k) low[k] = lift.at_vertex(low[k], sum[k], sum[3 + k], n);
    }
}

}  // namespace

const TileArithmetic kTiles53 = {
    Reversible53::kSteps, nullptr, 1, lift_tile_rows<LiftInteger>, lift_edge<LiftInteger>, lift_vertices<LiftInteger>};
const TileArithmetic kTiles97 = {Irreversible97::kSteps,    Irreversible97::kFactor.data(), Irreversible97::kLowGain,
                                 lift_tile_rows<LiftFloat>, lift_edge<LiftFloat>,           lift_vertices<LiftFloat>};
const TileArithmetic kTilesSharp = {Irreversible53::kSteps,   Irreversible53::kFactor.data(),
                                    Irreversible53::kLowGain, lift_tile_rows<LiftFloat>,
                                    lift_edge<LiftFloat>,     lift_vertices<LiftFloat>};

void TileSteps::synthesize() {
    share_details();
    for (int number = arithmetic_.steps - 1; number > 0; number -= 2) {
        update(arithmetic_.step(number, true));
        predict(arithmetic_.step(number - 1, true));
    }
}

void TileSteps::analyse() {
    for (int number = 0; number < arithmetic_.steps; number += 2) {
        predict(arithmetic_.step(number, false));
        update(arithmetic_.step(number + 1, false));
    }
}

template <class F>
void TileSteps::for_each_edge(const F& f) {
    for (uint32_t e = 0; e < complex_.edges; ++e) {
        const uint32_t h = complex_.lower[e], mate = complex_.mate[h];
        const uint32_t other = mate == kNoMate ? h : mate;
        f(Edge{planes_.sides[side_of(h)], planes_.sides[side_of(other)], tile(tile_of(h)), tile(tile_of(other)),
               mate != kNoMate});
    }
}

void TileSteps::share_details() {
    auto* bytes = static_cast<std::byte*>(samples_);
    for_each_edge([&](const Edge& e) {
        for (uint32_t i = 0; e.has_mate && i < planes_.h; ++i)
            std::memcpy(bytes + 4 * (e.mate + e.mate_side.high.at(planes_.h - 1 - i)),
                        bytes + 4 * (e.tile + e.side.high.at(i)), 12);
    });
}

// Details from low samples, borders included. Both tiles of an edge compute the same bits there.
void TileSteps::predict(const LiftStep& step) {
    const uint32_t h = planes_.h;
    const ptrdiff_t row = 3 * static_cast<ptrdiff_t>(h), low_row = row + 3;
    for (uint32_t t = 0; t < complex_.tiles; ++t) {
        const ptrdiff_t low = tile(t), horizontal = low + planes_.horizontal(), vertical = low + planes_.vertical();
        const Run diagonal = {low + planes_.diagonal(), row};
        const RowBlock from_horizontal = {diagonal, {horizontal, row}, {horizontal + row, row}, 3 * size_t{h}, h};
        const RowBlock from_vertical = {diagonal, {vertical, low_row}, {vertical + 3, low_row}, 3 * size_t{h}, h};
        arithmetic_.rows(step, samples_, step.undo ? from_vertical : from_horizontal);
        arithmetic_.rows(step, samples_, {{horizontal, row}, {low, low_row}, {low + 3, low_row}, 3 * size_t{h}, h + 1});
        arithmetic_.rows(step, samples_,
                         {{vertical, low_row}, {low, low_row}, {low + low_row, low_row}, 3 * size_t{h} + 3, h});
        arithmetic_.rows(step, samples_, step.undo ? from_horizontal : from_vertical);
    }
}

// Low samples and details from details.
void TileSteps::update(const LiftStep& step) {
    const auto inside = [&] {
        for (uint32_t t = 0; t < complex_.tiles; ++t) update_inside(step, tile(t));
    };
    const auto edges = [&] { for_each_edge([&](const Edge& e) { update_edge(step, e); }); };
    if (step.undo) {
        inside();
        edges();
        arithmetic_.vertices(step, complex_, planes_, samples_, sums_);
    } else {
        arithmetic_.vertices(step, complex_, planes_, samples_, sums_);
        edges();
        inside();
    }
}

void TileSteps::update_inside(const LiftStep& step, ptrdiff_t tile) {
    const uint32_t h = planes_.h;
    const ptrdiff_t row = 3 * static_cast<ptrdiff_t>(h), low_row = row + 3;
    const ptrdiff_t horizontal = tile + planes_.horizontal(), vertical = tile + planes_.vertical(),
                    diagonal = tile + planes_.diagonal();
    const Run low = {tile + low_row + 3, low_row};  // from here on, row 1 is the first
    const size_t all = 3 * size_t{h}, inside = all - 3;
    // In the order of synthesis: along rows, then along columns; of details, then of low samples.
    const RowBlock passes[4] = {
        {{vertical + 3, low_row}, {diagonal, row}, {diagonal + 3, row}, inside, h},
        {low, {horizontal + row, row}, {horizontal + row + 3, row}, inside, h - 1},
        {{horizontal + row, row}, {diagonal, row}, {diagonal + row, row}, all, h - 1},
        {low, {vertical + 3, low_row}, {vertical + low_row + 3, low_row}, inside, h - 1},
    };
    for (size_t i = 0; i < 4; ++i) arithmetic_.rows(step, samples_, passes[step.undo ? i : 3 - i]);
}

void TileSteps::update_edge(const LiftStep& step, const Edge& e) {
    const uint32_t h = planes_.h, last = h - 1;
    const auto lift = [&](Run TileSide::*target, uint32_t first, Run a, Run b) {
        arithmetic_.run(step, samples_,
                        {EdgeRun::from(e.side.*target, e.tile, first),
                         EdgeRun::from(e.mate_side.*target, e.mate, last, true), a, b, e.has_mate, h - first});
    };
    // What lies at the other side of the edge, in the direction of this one.
    const auto beyond = [&](Run TileSide::*run, uint32_t first) {
        return e.has_mate ? EdgeRun::from(e.mate_side.*run, e.mate, last, true)
                          : EdgeRun::from(e.side.*run, e.tile, first);
    };
    const auto along = [&] {
        lift(&TileSide::low, 1, EdgeRun::from(e.side.high, e.tile, 0), EdgeRun::from(e.side.high, e.tile, 1));
    };
    const auto across = [&] {
        lift(&TileSide::low, 1, EdgeRun::from(e.side.across, e.tile, 1), beyond(&TileSide::across, 1));
    };
    if (step.undo)
        along();
    else
        across();
    lift(&TileSide::high, 0, EdgeRun::from(e.side.faces, e.tile, 0), beyond(&TileSide::faces, 0));
    if (step.undo)
        across();
    else
        along();
}

}  // namespace gim
