#include "format/expectation.h"

#include <algorithm>

#include "format/inline.h"

namespace gim {
namespace {

constexpr size_t kRows = 5;

constexpr size_t row_size(uint32_t columns) { return (size_t{columns} + 2) * 3; }

constexpr int32_t kNothing[3] = {0, 0, 0};

// Writes the magnitudes of columns begin .. end-1 of a row. Columns outside the band, at most one at either end, get 0.
GIM_ALWAYS_INLINE void load_magnitudes(const Band& band, uint32_t row, ptrdiff_t begin, ptrdiff_t end,
                                       uint32_t* __restrict to) {
    const ptrdiff_t inner_begin = std::max<ptrdiff_t>(begin, 0);
    const ptrdiff_t inner_end = row < band.rows ? std::clamp<ptrdiff_t>(band.columns, inner_begin, end) : inner_begin;
    std::fill(to + begin * 3, to + inner_begin * 3, 0u);
    if (inner_begin < inner_end) {
        const int32_t* from = band.row(row);
        for (ptrdiff_t i = inner_begin * 3; i < inner_end * 3; ++i) to[i] = magnitude_of(from[i]);
    }
    std::fill(to + inner_end * 3, to + end * 3, 0u);
}

// Adds the magnitudes of another row.
GIM_ALWAYS_INLINE void add_magnitudes(const Band& band, uint32_t row, ptrdiff_t begin, ptrdiff_t end,
                                      uint32_t* __restrict to) {
    if (row >= band.rows) return;
    const int32_t* from = band.row(row);
    const ptrdiff_t inner_end = std::min<ptrdiff_t>(band.columns, end);
    for (ptrdiff_t i = std::max<ptrdiff_t>(begin, 0) * 3; i < inner_end * 3; ++i) to[i] += magnitude_of(from[i]);
}

// Weighs each parent and its four neighbours, for the two columns below it, of an even row and the next.
GIM_ALWAYS_INLINE void weigh_parents(const Band& parent, const BandWeights* weights, uint32_t row, uint32_t begin,
                                     uint32_t end, uint32_t* to) {
    const uint32_t inside = row < parent.rows ? std::clamp(parent.columns, begin, end) : begin;
    if (begin < inside) {
        const BandWeights first = weights[0], later = weights[1];
        const uint32_t parent_weight[3] = {first.parent, later.parent, later.parent};
        const uint32_t beside_weight[3] = {first.beside_parent, later.beside_parent, later.beside_parent};
        const int32_t* from = parent.row(row);
        const int32_t* up = row > 0 ? parent.row(row - 1) : kNothing;
        const int32_t* down = row + 1 < parent.rows ? parent.row(row + 1) : kNothing;
        for (uint32_t column = begin; column < inside; ++column) {
            const size_t at = size_t{column} * 3;
            const int32_t* left = column > 0 ? from + at - 3 : kNothing;
            const int32_t* right = column + 1 < parent.columns ? from + at + 3 : kNothing;
            const int32_t* above = up == kNothing ? kNothing : up + at;
            const int32_t* below = down == kNothing ? kNothing : down + at;
            for (size_t k = 0; k < 3; ++k) {
                to[2 * at + k] = to[2 * at + 3 + k] =
                    parent_weight[k] * magnitude_of(from[at + k]) +
                    beside_weight[k] * (magnitude_of(above[k]) + magnitude_of(below[k]) + magnitude_of(left[k]) +
                                        magnitude_of(right[k]));
            }
        }
    }
    std::fill(to + size_t{inside} * 6, to + size_t{end} * 6, 0u);
}

// What other bands of the level add: the first weight times the magnitude in `alone`, and the second one times the sum of
// two in `paired`, of the same place and of the next one.
struct Beside {
    const uint32_t *alone, *paired;
    uint32_t weights[2][2];  // of the first component and of later ones
};

// Sums up all that is expected in a row. kBeside: whether other bands add to it.
template <bool kBeside>
GIM_ALWAYS_INLINE void weigh(const BandWeights* weights, const Beside& beside, ptrdiff_t begin, ptrdiff_t end,
                             const BandWork& work) {
    const BandWeights first = weights[0], later = weights[1];
    const uint32_t *above = work.magnitudes, *parents = work.parents, *alone = beside.alone, *paired = beside.paired;
    uint32_t* __restrict expected = work.expected;
    const auto weigh_one = [&](const BandWeights& w, const uint32_t(&b)[2], ptrdiff_t i) {
        uint32_t e = w.constant + parents[i] + w.above * above[i] + w.corners * (above[i - 3] + above[i + 3]);
        if constexpr (kBeside) e += b[0] * alone[i] + b[1] * (paired[i] + paired[i + 3]);
        expected[i] = e;
    };
    for (ptrdiff_t i = begin * 3; i < end * 3; i += 3) {
        weigh_one(first, beside.weights[0], i);
        weigh_one(later, beside.weights[1], i + 1);
        weigh_one(later, beside.weights[1], i + 2);
    }
}

// Loads what the bands that are coded before have around the columns begin .. end-1 of a row.
GIM_ALWAYS_INLINE Beside load_beside(const BandSurroundings& around, uint32_t row, ptrdiff_t begin, ptrdiff_t end,
                                     const BandWork& work) {
    const BandWeights &first = around.weights[0], &later = around.weights[1];
    const bool vertical = around.orientation == Orientation::kVertical;
    const ptrdiff_t from = vertical ? begin - 1 : begin;
    load_magnitudes(*around.horizontal, row, from, end, work.horizontal);
    add_magnitudes(*around.horizontal, row + 1, from, end, work.horizontal);
    if (vertical) return {work.magnitudes, work.horizontal - 3, {{0, first.horizontal}, {0, later.horizontal}}};
    load_magnitudes(*around.vertical, row, begin, end + 1, work.vertical);
    return {work.horizontal, work.vertical, {{first.horizontal, first.vertical}, {later.horizontal, later.vertical}}};
}

}  // namespace

BandWork::BandWork(uint32_t* memory, uint32_t columns) {
    if (!memory) return;
    for (uint32_t** row : {&magnitudes, &expected, &parents, &horizontal, &vertical}) {
        *row = memory + 3;
        memory += row_size(columns);
    }
    full_above = memory;
}

size_t BandWork::size(uint32_t columns) { return row_size(columns) * kRows + block_count(columns); }

GIM_VECTOR_CLONES void expect(const BandSurroundings& around, uint32_t row, uint32_t begin, uint32_t end,
                              const BandWork& work) {
    const auto first = static_cast<ptrdiff_t>(begin), last = static_cast<ptrdiff_t>(end);
    if (around.parent && row % 2 == 0)
        weigh_parents(*around.parent, around.weights, row / 2, begin / 2, (end + 1) / 2, work.parents);
    if (!around.parent) std::fill(work.parents + first * 3, work.parents + last * 3, 0u);
    if (around.orientation == Orientation::kHorizontal)
        weigh<false>(around.weights, {}, first, last, work);
    else
        weigh<true>(around.weights, load_beside(around, row, first, last, work), first, last, work);
}

}  // namespace gim
