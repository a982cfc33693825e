// Loads the decoded integers of one wavelet step into the planes of the tiles, as samples.
#pragma once

#include <algorithm>
#include <cstdint>

#include "format/detail_frame.h"
#include "format/quad_complex.h"
#include "format/tile_frames.h"
#include "format/tile_planes.h"

namespace gim {

// Values of kinds that are not in frames: integers as they are.
inline void load_tile_details(const QuadComplex& complex, const TilePlanes& planes, const int32_t* details,
                              int32_t* samples) {
    for (uint32_t t = 0; t < complex.tiles; ++t)
        std::copy_n(details + t * planes.details(), planes.details(),
                    samples + t * planes.size() + planes.horizontal());
}

// Floats, dequantized and out of their frames. The details of an edge are loaded in the tile of its lower half-edge only.
class TileDetails {
  public:
    TileDetails(const QuadComplex& complex, const TilePlanes& planes, const DetailSteps& steps, float* samples)
        : complex_(complex), planes_(planes), steps_(steps), samples_(samples), frames_(complex, planes, samples) {}

    void load(const int32_t* details) {
        for (uint32_t t = 0; t < complex_.tiles; ++t) {
            const int32_t* from = details + t * planes_.details();
            float* to = samples_ + t * planes_.size() + planes_.horizontal();
            if (steps_.in_frames)
                load_framed(t, from, to);
            else
                load_plain(from, to);
        }
        write();
    }

  private:
    static constexpr uint32_t kLanes = 64;

    void load_plain(const int32_t* from, float* to) const {
        const auto faces = static_cast<size_t>(planes_.diagonal() - planes_.horizontal());
        for (size_t i = 0; i < planes_.details(); ++i)
            to[i] = dequantize(from[i], i < faces ? steps_.edge : steps_.diagonal);
    }

    void load_framed(uint32_t tile, const int32_t* from, float* to) {
        std::fill_n(to, planes_.details(), 0.0f);
        const auto is_known = [&](uint32_t side) { return complex_.mate[4 * tile + side] < 4 * tile + side; };
        const uint32_t h = planes_.h;
        load_band(tile, Orientation::kHorizontal, {is_known(0), h + 1 - is_known(2)}, {0, h}, from, to);
        const ptrdiff_t vertical = planes_.vertical() - planes_.horizontal();
        load_band(tile, Orientation::kVertical, {0, h}, {is_known(3), h + 1 - is_known(1)}, from + vertical,
                  to + vertical);
        const ptrdiff_t diagonal = planes_.diagonal() - planes_.horizontal();
        load_band(tile, Orientation::kDiagonal, {0, h}, {0, h}, from + diagonal, to + diagonal);
    }

    struct Range {
        uint32_t begin, end;
    };
    void load_band(uint32_t tile, Orientation orientation, Range rows, Range columns, const int32_t* from, float* to) {
        const size_t width = 3 * size_t{planes_.h + (orientation == Orientation::kVertical)};
        for (uint32_t row = rows.begin; row < rows.end; ++row) {
            const int32_t* values = from + row * width;
            int32_t any = 0;
            for (size_t i = 0; i < width; ++i) any |= values[i];
            if (any == 0) continue;
            for (uint32_t column = columns.begin; column < columns.end; ++column) {
                const int32_t* v = values + 3 * size_t{column};
                if ((v[0] | v[1] | v[2]) == 0) continue;
                frames_.find_tangents(tile, orientation, row, column, lanes_, count_);
                const float step = steps_.of(orientation);
                for (uint32_t k = 0; k < 3; ++k) values_[k][count_] = v[k];
                step_[count_] = step;
                to_[count_++] = to + row * width + 3 * size_t{column};
                if (count_ == kLanes) write();
            }
        }
    }

    // Writes the gathered details.
    void write() {
        if (count_ == 0) return;
        const size_t rounded = lanes::whole_groups<kLanes>(count_);
        make_frames(lanes_, count_, steps_.cell_area);
        const auto& axis = lanes_.axis;
        for (size_t i = 0; i < rounded; ++i) {
            const float tangential = step_[i] * steps_.tangential;
            const float a = dequantize(values_[0][i], step_[i] * lanes_.scale[i]);
            const float b = dequantize(values_[1][i], tangential), c = dequantize(values_[2][i], tangential);
            for (uint32_t k = 0; k < 3; ++k) details_[k][i] = dot(axis[0][k][i], a, axis[1][k][i], b, axis[2][k][i], c);
        }
        for (uint32_t i = 0; i < count_; ++i)
            for (uint32_t k = 0; k < 3; ++k) to_[i][k] = details_[k][i];
        count_ = 0;
    }

    const QuadComplex& complex_;
    const TilePlanes& planes_;
    const DetailSteps& steps_;
    float* samples_;
    TileFrames frames_;
    uint32_t count_ = 0;  // lanes in use
    DetailLanes<kLanes> lanes_;
    int32_t values_[3][kLanes] = {};
    float step_[kLanes] = {}, details_[3][kLanes];
    float* to_[kLanes];
};

}  // namespace gim
