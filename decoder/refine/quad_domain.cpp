#include "decoder/refine/quad_domain.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "decoder/pyramid/vector3.h"

namespace gim {
namespace {

constexpr uint64_t kFree = UINT64_MAX;

// A set of pairs of vertices, in memory of the caller.
class EdgeSet {
  public:
    EdgeSet(uint64_t* slots, uint32_t count) : slots_(slots), mask_(count - 1) { std::fill_n(slots, count, kFree); }

    // Returns whether the pair is new.
    bool insert(uint32_t a, uint32_t b) {
        uint64_t* slot = find(a, b);
        const bool is_new = *slot == kFree;
        *slot = key(a, b);
        return is_new;
    }
    bool contains(uint32_t a, uint32_t b) { return *find(a, b) != kFree; }

  private:
    static uint64_t key(uint32_t a, uint32_t b) { return uint64_t{std::min(a, b)} << 32 | std::max(a, b); }
    uint64_t* find(uint32_t a, uint32_t b) {
        const uint64_t wanted = key(a, b);
        uint64_t at = (wanted * 0x9e3779b97f4a7c15u) >> 20;
        while (slots_[at & mask_] != kFree && slots_[at & mask_] != wanted) ++at;
        return slots_ + (at & mask_);
    }

    uint64_t* slots_;
    uint64_t mask_;
};

float distance(const float* a, const float* b) { return std::sqrt(squared_distance(a, b)); }

// The vertices that matter to one split: the edge's ends and the sample in its middle.
struct SplitEdge {
    uint32_t a, b, middle;
};

class Rating {
  public:
    Rating(const QuadDomain& domain, SampleValue* values) : domain_(domain), values_(values) {}

    // Every tile has the splits of each step; those on its sides belong to two tiles. A split's error counts all that come
    // after it, so later steps come first.
    void run() {
        const uint32_t tiles = domain_.shape().tiles;
        for (uint32_t cell = 2; cell <= domain_.shape().intervals; cell *= 2) {
            for (uint32_t t = 0; t < tiles; ++t)
                for_each_cell(cell, [&](uint32_t r, uint32_t c) { sides(t, r, c, cell); });
            for (uint32_t t = 0; t < tiles; ++t)
                for_each_cell(cell, [&](uint32_t r, uint32_t c) { centre(t, r, c, cell); });
        }
    }

  private:
    template <class F>
    void for_each_cell(uint32_t cell, const F& f) const {
        const uint32_t n = domain_.shape().intervals;
        for (uint32_t row = 0; row < n; row += cell) {
            for (uint32_t column = 0; column < n; column += cell) f(row, column);
        }
    }
    uint32_t at(uint32_t tile, uint32_t row, uint32_t column) const { return domain_.vertex_at(tile, row, column); }

    // Splits in the middles of a cell's sides. After each come those in the centres of the quarters beside it.
    void sides(uint32_t t, uint32_t r, uint32_t c, uint32_t cell) {
        const uint32_t half = cell / 2, quarter = cell / 4;
        const uint32_t corners[4] = {at(t, r, c), at(t, r, c + cell), at(t, r + cell, c + cell), at(t, r + cell, c)};
        const uint32_t middles[4] = {at(t, r, c + half), at(t, r + half, c + cell), at(t, r + cell, c + half),
                                     at(t, r + half, c)};
        for (uint32_t i = 0; i < 4; ++i) {
            own({corners[i], corners[(i + 1) % 4], middles[i]});
            if (quarter == 0) continue;
            for (const uint32_t q : {i, (i + 1) % 4}) {  // the quarters at both ends of the side, by their corner
                const uint32_t right = q == 1 || q == 2, down = q >= 2;
                below(middles[i], at(t, r + down * half + quarter, c + right * half + quarter));
            }
        }
    }

    // The split in the centre of a cell. After it come those in the middles of its sides.
    void centre(uint32_t t, uint32_t r, uint32_t c, uint32_t cell) {
        const uint32_t half = cell / 2, middle = at(t, r + half, c + half);
        const bool is_anti = diagonal_is_anti(t, r, c, cell);
        const uint32_t a = is_anti ? at(t, r, c + cell) : at(t, r, c),
                       b = is_anti ? at(t, r + cell, c) : at(t, r + cell, c + cell);
        own({a, b, middle});
        for (const uint32_t side :
             {at(t, r, c + half), at(t, r + half, c + cell), at(t, r + cell, c + half), at(t, r + half, c)})
            below(middle, side);
    }

    // Below the base, diagonals run through the centre of the cell of twice the size.
    bool diagonal_is_anti(uint32_t t, uint32_t r, uint32_t c, uint32_t cell) const {
        if (cell == domain_.shape().intervals) return domain_.glue().is_anti[t] != 0;
        return (r / cell + c / cell) % 2 != 0;
    }

    void own(const SplitEdge& edge) {
        SampleValue& value = values_[edge.middle];
        const float *a = values_[edge.a].position, *b = values_[edge.b].position;
        const float straight[3] = {0.5f * (a[0] + b[0]), 0.5f * (a[1] + b[1]), 0.5f * (a[2] + b[2])};
        value.error = std::max(value.error, distance(straight, value.position));
        // The ball also holds the edge, so that the error on screen is no less where the eye is near to the edge.
        value.radius = std::max({value.radius, distance(a, value.position), distance(b, value.position)});
    }
    void below(uint32_t vertex, uint32_t child) {
        SampleValue& value = values_[vertex];
        value.error = std::max(value.error, values_[child].error);
        value.radius =
            std::max(value.radius, distance(value.position, values_[child].position) + values_[child].radius);
    }

    const QuadDomain& domain_;
    SampleValue* values_;
};

}  // namespace

TileGlue lay_out_glue(const DomainShape& shape, Arena* arena) {
    const size_t half_edges = size_t{4} * shape.tiles;
    TileGlue glue;
    for (uint32_t** array : {&glue.mate, &glue.corner, &glue.along}) *array = arena->take<uint32_t>(half_edges);
    glue.step = arena->take<int32_t>(half_edges);
    glue.inner = arena->take<uint32_t>(shape.tiles);
    glue.is_anti = arena->take<uint8_t>(shape.tiles);
    return glue;
}

// At most 3 edges a tile are new, so half of the slots stay free.
uint32_t edge_slots(const DomainShape& shape) { return std::bit_ceil(10 * std::max(shape.tiles, 1u)); }

void choose_diagonals(const DomainShape& shape, const float* positions, uint64_t* edges, TileGlue* glue) {
    EdgeSet taken(edges, edge_slots(shape));
    const auto corner = [&](uint32_t t, uint32_t i) { return glue->corner[4 * t + i]; };
    const auto position = [&](uint32_t v) { return positions + 3 * size_t{v}; };
    for (uint32_t h = 0; h < 4 * shape.tiles; ++h) taken.insert(glue->corner[h], glue->corner[next_side(h)]);
    for (uint32_t t = 0; t < shape.tiles; ++t) {
        bool is_anti = distance(position(corner(t, 1)), position(corner(t, 3))) <
                       distance(position(corner(t, 0)), position(corner(t, 2)));
        const auto may_be = [&](bool anti) {
            const uint32_t a = corner(t, anti ? 1 : 0), b = corner(t, anti ? 3 : 2);
            return a != b && !taken.contains(a, b);
        };
        if (!may_be(is_anti) && may_be(!is_anti)) is_anti = !is_anti;
        glue->is_anti[t] = is_anti;
        taken.insert(corner(t, is_anti ? 1 : 0), corner(t, is_anti ? 3 : 2));
    }
}

void rate_samples(const QuadDomain& domain, const float* positions, SampleValue* values) {
    for (uint32_t v = 0; v < domain.shape().vertices; ++v) {
        values[v] = {};
        std::copy_n(positions + 3 * size_t{v}, 3, values[v].position);
    }
    Rating(domain, values).run();
}

}  // namespace gim
