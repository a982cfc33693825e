#include "format/quad_complex.h"

#include <algorithm>

namespace gim {
namespace {

using Kind = QuadFault::Kind;

// Calls f(half-edge) for the half-edges that start at the vertex of `first`, in one turn around it. Stops at a boundary.
// Returns whether the turn was complete.
template <class F>
bool turn_around(const uint32_t* mate, uint32_t first, const F& f) {
    uint32_t h = first;
    do {
        f(h);
        h = mate[previous_side(h)];
    } while (h != kNoMate && h != first);
    return h == first;
}

// Calls f(half-edge) for the half-edges that start at the vertex of `first`. Returns whether it is inside the surface.
template <class F>
bool for_each_around(const uint32_t* mate, uint32_t first, const F& f) {
    if (turn_around(mate, first, f)) return true;
    for (uint32_t m = mate[first]; m != kNoMate;) {  // the other way, up to the other boundary
        const uint32_t h = next_side(m);
        f(h);
        m = mate[h];
    }
    return false;
}

}  // namespace

QuadFault find_mates(std::span<const Quad> quads, uint32_t vertices, std::span<uint32_t> work, uint32_t* mate) {
    const auto count = static_cast<uint32_t>(4 * quads.size());
    const auto start_of = [&](uint32_t h) { return quads[tile_of(h)][side_of(h)]; };
    const auto end_of = [&](uint32_t h) { return start_of(next_side(h)); };
    for (uint32_t q = 0; q < quads.size(); ++q) {
        for (uint32_t i = 0; i < 4; ++i) {
            if (quads[q][i] >= vertices) return {Kind::kNoVertex, q};
            for (uint32_t k = 0; k < i; ++k)
                if (quads[q][i] == quads[q][k]) return {Kind::kRepeated, q};
        }
    }

    // The half-edges that start at each vertex, by their ends.
    uint32_t *first = work.data(), *sorted = first + vertices + 1;
    std::fill_n(first, vertices + 1, 0u);
    for (uint32_t h = 0; h < count; ++h) ++first[start_of(h)];
    for (uint32_t v = 0, sum = 0; v <= vertices; ++v) {
        sum += first[v];
        first[v] = sum;
    }
    for (uint32_t h = count; h-- > 0;) sorted[--first[start_of(h)]] = h;
    const auto by_end = [&](uint32_t a, uint32_t b) { return end_of(a) < end_of(b); };
    for (uint32_t v = 0; v < vertices; ++v) {
        if (first[v] == first[v + 1]) return {Kind::kUnusedVertex, v};
        std::sort(sorted + first[v], sorted + first[v + 1], by_end);
        for (uint32_t i = first[v] + 1; i < first[v + 1]; ++i)
            if (end_of(sorted[i - 1]) == end_of(sorted[i])) return {Kind::kCrowdedEdge, sorted[i]};
    }
    for (uint32_t h = 0; h < count; ++h) {
        const uint32_t from = end_of(h), to = start_of(h);
        uint32_t* end = sorted + first[from + 1];
        uint32_t* found =
            std::lower_bound(sorted + first[from], end, to, [&](uint32_t a, uint32_t v) { return end_of(a) < v; });
        mate[h] = found != end && end_of(*found) == to ? *found : kNoMate;
    }
    for (uint32_t v = 0; v < vertices; ++v) {
        uint32_t in_fan = 0;
        for_each_around(mate, sorted[first[v]], [&](uint32_t) { ++in_fan; });
        if (in_fan != first[v + 1] - first[v]) return {Kind::kTouchingTiles, v};
    }
    return {};
}

bool number_complex(QuadComplex* complex) {
    const uint32_t count = complex->half_edges();
    std::fill_n(complex->vertex, count, kNoMate);
    complex->vertices = complex->edges = 0;
    for (uint32_t h = 0; h < count; ++h) {
        const uint32_t m = complex->mate[h];
        if (m > h) {  // kNoMate, too
            complex->lower[complex->edges] = h;
            complex->edge[h] = complex->edges++;
        } else {
            complex->edge[h] = complex->edge[m];
        }
        if (complex->vertex[h] != kNoMate) continue;
        const uint32_t v = complex->vertices++;
        uint32_t valence = 0;
        const bool inside = for_each_around(complex->mate, h, [&](uint32_t around) {
            complex->vertex[around] = v;
            ++valence;
        });
        complex->valence[v] = valence;
        complex->on_boundary[v] = inside ? 0 : 1;
    }
    for (uint32_t h = 0; h < count; h += 4) {
        const uint32_t* v = complex->vertex + h;
        if (v[0] == v[1] || v[0] == v[2] || v[0] == v[3] || v[1] == v[2] || v[1] == v[3] || v[2] == v[3]) return false;
    }
    return true;
}

}  // namespace gim
