// Codes the base of a complex: one triple of integers for each vertex, predicted from the vertices before it.
// spec/gim-format.md, "Tiles". After: Touma, Gotsman. Triangle Mesh Compression. 1998 (parallelograms); Cohen-Or, Cohen,
// Irony. Multi-way Geometry Encoding. 2002 (the mean of several).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "format/band_code.h"
#include "format/quad_complex.h"

namespace gim {

// Values of the base are smaller, so that differences of four of them can be coded.
inline constexpr int32_t kMostBaseValue = int32_t{1} << 22;

// Expects each vertex from those with lower numbers. Of its tiles, of its edges, of its neighbours as many count as are
// known.
class BasePrediction {
  public:
    using Triple = std::array<int64_t, 3>;

    BasePrediction(const QuadComplex& complex, const int32_t* values) : complex_(complex), values_(values) {}

    struct Place {
        Triple at = {0, 0, 0};
        uint32_t doubt = 8;  // how far the vertex is from there, about, as a multiple of the usual distance / 4
    };
    // first: the first half-edge that starts at the vertex.
    Place of(uint32_t first) const {
        const uint32_t v = complex_.vertex[first];
        Mean neighbours, parallelograms, lines;
        for_each_corner(first, [&](uint32_t h) {
            const uint32_t next = end(h), previous = complex_.vertex[previous_side(h)], across = end(next_side(h));
            if (next < v) neighbours.add(at(next));
            if (next < v && across < v && previous < v) parallelograms.add(sum(at(next), at(previous), at(across)));
            add_line(h, v, lines);
            if (previous < v && complex_.mate[previous_side(h)] == kNoMate) neighbours.add(at(previous));
        });
        Place place;
        if (neighbours.count == 0) {
            if (v > 0) place.at = at(v - 1);
            return place;
        }
        const Triple n = neighbours.value(), p = parallelograms.value(), l = lines.value();
        const bool has_lines = lines.count > 0;
        for (size_t k = 0; k < 3; ++k) {
            if (parallelograms.count > 0)
                place.at[k] = has_lines ? (n[k] + 4 * p[k] + 3 * l[k]) >> 3 : (3 * n[k] + 5 * p[k]) >> 3;
            else
                place.at[k] = has_lines ? (n[k] + 3 * l[k]) >> 2 : n[k];
        }
        place.doubt = parallelograms.count > 1 ? 3 : parallelograms.count > 0 ? 4 : has_lines ? 7 : 8;
        return place;
    }

  private:
    // Lines end at vertices with more tiles, so that a vertex costs little time.
    static constexpr uint32_t kMostTilesAround = 8;

    struct Mean {
        Triple sum = {0, 0, 0};
        int64_t count = 0;

        void add(const Triple& t) {
            for (size_t k = 0; k < 3; ++k) sum[k] += t[k];
            ++count;
        }
        Triple value() const {  // rounded down
            Triple mean = sum;
            if (count > 1)
                for (int64_t& m : mean) m = (m - (m % count + count) % count) / count;
            return mean;
        }
    };

    uint32_t end(uint32_t half_edge) const { return complex_.vertex[next_side(half_edge)]; }
    Triple at(uint32_t vertex) const {
        const int32_t* v = values_ + 3 * size_t{vertex};
        return {v[0], v[1], v[2]};
    }
    static Triple sum(const Triple& a, const Triple& b, const Triple& less) {
        return {a[0] + b[0] - less[0], a[1] + b[1] - less[1], a[2] + b[2] - less[2]};
    }

    // Calls f(h) for all half-edges that start where `first` starts.
    template <class F>
    void for_each_corner(uint32_t first, const F& f) const {
        uint32_t h = first;
        do {
            f(h);
            h = complex_.mate[previous_side(h)];
        } while (h != kNoMate && h != first);
        if (h == first) return;
        for (h = complex_.mate[first]; h != kNoMate; h = complex_.mate[h]) {
            h = next_side(h);
            f(h);
        }
    }

    // Half-edge h runs from vertex v to a neighbour. Goes on straight from what lies beyond the neighbour to v. Beyond are
    // the edge with as many tiles on either side, or two edges.
    void add_line(uint32_t h, uint32_t v, Mean& lines) const {
        const uint32_t neighbour = end(h), valence = complex_.valence[neighbour];
        if (neighbour >= v || complex_.on_boundary[neighbour] || valence > kMostTilesAround) return;
        Mean beyond;
        uint32_t back = complex_.mate[h];  // turns around the neighbour
        for (uint32_t turn = 0; turn <= (valence + 1) / 2; ++turn) {
            if (turn >= valence / 2 && end(back) < v) beyond.add(at(end(back)));
            back = complex_.mate[previous_side(back)];
        }
        if (beyond.count > 0) lines.add(sum(at(neighbour), at(neighbour), beyond.value()));
    }

    const QuadComplex& complex_;
    const int32_t* values_;
};

template <class Coder>
class BaseCoder {
  public:
    BaseCoder(Coder* coder, BandModels* models) : coder_(*coder), models_(*models) {}

    // values: 3 * complex.vertices numbers. Returns false if a number is larger than any that an encoder writes.
    bool code(const QuadComplex& complex, int32_t* values) {
        const BasePrediction prediction(complex, values);
        uint32_t known = 0;  // vertices are numbered by first appearance
        for (uint32_t h = 0; h < complex.half_edges(); ++h) {
            if (complex.vertex[h] < known) continue;
            if (!code_vertex(prediction.of(h), known, values + 3 * size_t{known})) return false;
            ++known;
        }
        return true;
    }

  private:
    bool code_vertex(const BasePrediction::Place& place, uint32_t number, int32_t* values) {
        const auto expected = static_cast<uint32_t>(uint64_t{usual_} * place.doubt / 4);
        uint32_t sum = 0;
        for (size_t k = 0; k < 3; ++k) {
            const auto guess = static_cast<uint32_t>(place.at[k]);
            int32_t difference = 0;
            if constexpr (Coder::kWrites) difference = static_cast<int32_t>(static_cast<uint32_t>(values[k]) - guess);
            uint32_t m = magnitude_of(difference);
            if (!code_magnitude(coder_, models_, 0, expected, false, &m)) return false;
            const bool negative = m > 0 && coder_.code_raw(difference < 0, 1);
            values[k] = static_cast<int32_t>(guess + (negative ? 0u - m : m));
            sum += std::min(m, kMostCounted);
        }
        if (number == 0) return true;  // where the surface lies tells nothing of distances
        const auto seen = static_cast<int64_t>(uint64_t{1024} * sum / (3 * place.doubt));
        const auto usual = int64_t{usual_};
        usual_ = static_cast<uint32_t>(usual + (seen - usual) / std::min<int64_t>(number, kMemory));
        return true;
    }

    static constexpr uint32_t kMostCounted = 1u << 20;
    static constexpr int64_t kMemory = 8;  // vertices that the mean goes back, about

    Coder& coder_;
    BandModels& models_;
    uint32_t usual_ = 131072;  // mean magnitude, in 1/256
};

}  // namespace gim
