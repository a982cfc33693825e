// Codes the base of a complex: one triple of integers for each vertex, predicted from the vertices before it.
// spec/gim-format.md, "Tiles". After: Touma, Gotsman. Triangle Mesh Compression. 1998 (parallelograms).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "format/band_code.h"
#include "format/quad_complex.h"

namespace gim {

// Values of the base are smaller, so that differences of four of them can be coded.
inline constexpr int32_t kMostBaseValue = int32_t{1} << 22;

template <class Coder>
class BaseCoder {
  public:
    BaseCoder(Coder* coder, BandModels* models) : coder_(*coder), models_(*models) {}

    // values: 3 * complex.vertices numbers. Returns false if a number is larger than any that an encoder writes.
    bool code(const QuadComplex& complex, int32_t* values) {
        values_ = values;
        uint32_t known = 0;  // vertices are numbered by first appearance
        for (uint32_t first = 0; first < complex.half_edges(); first += 4) {
            const uint32_t* v = complex.vertex + first;
            const uint32_t mate = complex.mate[first];
            for (uint32_t i = 0; i < 4; ++i) {
                if (v[i] < known) continue;
                if (!code_vertex(predict(complex, v, mate < first ? mate : kNoMate, i, known), v[i])) return false;
                ++known;
            }
        }
        return true;
    }

  private:
    using Triple = std::array<int64_t, 3>;

    int64_t at(uint32_t vertex, size_t k) const { return values_[3 * size_t{vertex} + k]; }

    // The place where corner i of a tile is expected. v: the corners; those below `known` are known. mate: the mate of
    // side 0 if its tile is known.
    Triple predict(const QuadComplex& complex, const uint32_t* v, uint32_t mate, uint32_t i, uint32_t known) const {
        Triple place = {0, 0, 0};
        if (mate == kNoMate) {
            for (size_t k = 0; k < 3; ++k)
                place[k] = i == 0 ? 0 : i == 3 ? at(v[0], k) + at(v[2], k) - at(v[1], k) : at(v[i - 1], k);
            return place;
        }
        // Corner 2 goes on from corner 1, corner 3 from corner 0, as far as the tile before reached back from there. If
        // the fourth corner is known, it completes a parallelogram, too.
        const uint32_t near = v[3 - i], side = v[i - 2], fourth = v[5 - i];
        const uint32_t back = complex.vertex[i == 2 ? previous_side(mate) : previous_side(previous_side(mate))];
        for (size_t k = 0; k < 3; ++k) {
            const int64_t on = 2 * at(near, k) - at(back, k);
            place[k] = fourth < known ? (on + at(near, k) + at(fourth, k) - at(side, k)) >> 1 : on;
        }
        return place;
    }

    bool code_vertex(const Triple& expected, uint32_t vertex) {
        for (size_t k = 0; k < 3; ++k) {
            int32_t& value = values_[3 * size_t{vertex} + k];
            const auto guess = static_cast<uint32_t>(expected[k]);
            int32_t difference = 0;
            if constexpr (Coder::kWrites) difference = static_cast<int32_t>(static_cast<uint32_t>(value) - guess);
            uint32_t m = magnitude_of(difference);
            if (!code_magnitude(coder_, models_, 0, mean_[k], false, &m)) return false;
            const bool negative = m > 0 && coder_.code_raw(difference < 0, 1);
            value = static_cast<int32_t>(guess + (negative ? 0u - m : m));
            mean_[k] = (3 * mean_[k] + 256 * std::min(m, kMostCounted)) / 4;
        }
        return true;
    }

    static constexpr uint32_t kMostCounted = 1u << 20;

    Coder& coder_;
    BandModels& models_;
    int32_t* values_ = nullptr;
    std::array<uint32_t, 3> mean_ = {131072, 131072, 131072};  // of magnitudes, in 1/256
};

}  // namespace gim
