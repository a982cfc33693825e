// The frames in which lossy details of positions are coded: the normal and two tangents of the coarser image at the
// place of the detail. Quantizer steps follow the area there.  spec/gim-format.md, "Frames".
//
// After: Zorin, Schroeder, Sweldens. Interactive Multiresolution Mesh Editing. 1997 (details in local frames);
// Khodakovsky, Guskov. Compression of Normal Meshes. 2003 (tangential details quantized more coarsely). Steps shrink
// where the image spreads few samples over much surface: one wrong sample is much wrong surface there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "format/band_code.h"
#include "format/container.h"
#include "format/lifting.h"

namespace gim {

// How the details of one wavelet step are quantized. Without frames (attribute planes) x, y and z have the same step.
struct DetailSteps {
    float edge = 1, diagonal = 1;  // normal steps at scale 1, of bands high in one direction and in both
    bool in_frames = false;
    float tangential = 1;  // tangential step / normal step
    float cell_area = 0;   // units^2: a cell of the small image with this area has scale 1; 0: all have

    float of(Orientation orientation) const { return orientation == Orientation::kDiagonal ? diagonal : edge; }
};

// How the details of all wavelet steps of an image are quantized.
struct DetailCoding {
    float quantizer = 0;  // units
    bool in_frames = false;
    float tangential = 1;
    float cell_area = 0;  // as in DetailSteps, but of the image at full resolution

    // depth: 1 for the finest bands.
    DetailSteps steps_at(uint32_t depth) const {
        return {band_step(quantizer, depth, Orientation::kHorizontal),
                band_step(quantizer, depth, Orientation::kDiagonal), in_frames, tangential,
                cell_area * static_cast<float>(uint64_t{1} << (2 * depth))};
    }
};

// The coding of positions in a lossy file.
inline DetailCoding detail_coding_of(const Units& units) {
    return {units.quantizer, units.tangential > 0, static_cast<float>(units.tangential) / 8,
            cell_area_of(units.cell_area)};
}

inline CoefficientKind coefficient_kind_of(const Units& units) {
    return units.tangential > 0 ? CoefficientKind::kInFrames : CoefficientKind::kPlain;
}
inline CoefficientKind tile_kind_of(const Units& units) {
    return units.tangential > 0 ? CoefficientKind::kTilesInFrames : CoefficientKind::kTiles;
}

struct DetailFrame {
    float axis[3][3];  // unit normal, unit tangent along the row, unit tangent across; right-handed
    float scale;       // of the step along the normal
};

inline constexpr float kMostAreaRatio = 4096;        // scale: 1/8 .. 8
inline constexpr uint32_t kLeastScaledSide = 9;      // smaller images tell nothing about area
inline constexpr float kLargestFrameUnit = 0x1p40f;  // greater areas and tangents make no frame

// Up to N details, stored component by component, so that compilers vectorise loops over them.
template <size_t N>
struct DetailLanes {
    // Tangents along the row and across.
    float u[3][N] = {}, v[3][N] = {};
    // The frame. axis[a][k]: component k of axis a.
    float area[N] = {}, along[N] = {};
    float axis[3][3][N] = {}, scale[N] = {};
};

namespace lanes {

// Rounds up to a multiple of four: a few stale lanes more are cheaper than the remainder of a loop.
template <size_t N>
constexpr size_t whole_groups(size_t count) {
    return N % 4 == 0 ? (count + 3) / 4 * 4 : count;
}

// Functions of vector i in arrays by component.
template <size_t N>
float squared_length(const float (&a)[3][N], size_t i) {
    return a[0][i] * a[0][i] + a[1][i] * a[1][i] + a[2][i] * a[2][i];
}
template <size_t N>
void cross(const float (&a)[3][N], const float (&b)[3][N], float (&out)[3][N], size_t i) {
    const float x = a[1][i] * b[2][i] - a[2][i] * b[1][i];
    const float y = a[2][i] * b[0][i] - a[0][i] * b[2][i];
    const float z = a[0][i] * b[1][i] - a[1][i] * b[0][i];
    out[0][i] = x;
    out[1][i] = y;
    out[2][i] = z;
}

template <size_t N>
void make_scales(DetailLanes<N>& lanes, size_t count, float cell_area) {
    auto& scale = lanes.scale;
    std::fill_n(scale, count, 1.0f);
    if (!(cell_area > 0)) return;
    for (size_t i = 0; i < count; ++i) scale[i] = std::max(cell_area / lanes.area[i], 1 / kMostAreaRatio);
    for (size_t i = 0; i < count; ++i) scale[i] = std::min(scale[i], kMostAreaRatio);
    for (size_t i = 0; i < count; ++i) scale[i] = std::sqrt(scale[i]);
    for (size_t i = 0; i < count; ++i) scale[i] = std::sqrt(scale[i]);
}

// Returns 0 for a NaN, too. Has no branches.
inline int makes_frame(float area, float along) {
    return (area > 0x1p-40f) & (along > 0x1p-40f) & (area < kLargestFrameUnit) & (along < kLargestFrameUnit);
}
template <size_t N>
void use_plain_frame(DetailLanes<N>& lanes, size_t i) {
    for (int a = 0; a < 3; ++a)
        for (int k = 0; k < 3; ++k) lanes.axis[a][k][i] = k == (a + 2) % 3 ? 1.0f : 0.0f;
    lanes.scale[i] = 1;
}

}  // namespace lanes

// Makes the frames of the first lanes from their tangents. cell_area: as in DetailSteps.
template <size_t N>
void make_frames(DetailLanes<N>& all, size_t count, float cell_area) {
    count = lanes::whole_groups<N>(count);
    auto& [u, v, area, along, axis, scale] = all;
    auto& [normal, tangent, across] = axis;
    for (size_t i = 0; i < count; ++i) {
        lanes::cross(u, v, normal, i);
        area[i] = lanes::squared_length(normal, i);
        along[i] = lanes::squared_length(u, i);
    }
    for (size_t i = 0; i < count; ++i) area[i] = std::sqrt(area[i]);
    for (size_t i = 0; i < count; ++i) along[i] = std::sqrt(along[i]);
    for (size_t i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) {
            normal[k][i] = normal[k][i] / area[i];
            tangent[k][i] = u[k][i] / along[i];
        }
        lanes::cross(normal, tangent, across, i);
    }
    lanes::make_scales(all, count, cell_area);
    int every = 1;
    for (size_t i = 0; i < count; ++i) every &= lanes::makes_frame(area[i], along[i]);
    if (every) return;
    for (size_t i = 0; i < count; ++i) {
        if (!lanes::makes_frame(area[i], along[i])) lanes::use_plain_frame(all, i);
    }
}

// The frame of a single lane.
inline DetailFrame frame_of(const DetailLanes<1>& one) {
    DetailFrame frame;
    for (int a = 0; a < 3; ++a)
        for (int k = 0; k < 3; ++k) frame.axis[a][k] = one.axis[a][k][0];
    frame.scale = one.scale[0];
    return frame;
}

// The small image that details are added to: rows * columns triples in units.
class FrameField {
  public:
    FrameField(const float* image, uint32_t columns, uint32_t rows, float cell_area)
        : image_(image),
          columns_(columns),
          rows_(rows),
          cell_area_(std::min(columns, rows) < kLeastScaledSide ? 0 : cell_area) {}

    // The frame of a band's detail at (row, column). The detail lies between that sample of the small image and the
    // next one in the direction of high frequency.
    DetailFrame at(Orientation orientation, uint32_t row, uint32_t column) const {
        DetailLanes<1> one;
        find_tangents(orientation, row, &column, 1, one);
        make_frames(one, 1);
        return frame_of(one);
    }

    // Does the same for many details in two steps. find_tangents fills lanes from `first` on with the tangents at some
    // columns of a row. make_frames then makes the frames of all lanes.
    template <size_t N>
    void find_tangents(Orientation orientation, uint32_t row, const uint32_t* columns, size_t count,
                       DetailLanes<N>& lanes, size_t first = 0) const {
        const float *before = row_at(std::max(row, 1u) - 1), *here = row_at(row),
                    *below = row_at(std::min(row + 1, rows_ - 1));
        // The difference spans two rows if both neighbours exist.
        const float across_rows = row > 0 && row + 1 < rows_ ? 0.25f : 0.5f;
        auto &u = lanes.u, &v = lanes.v;
        for (size_t i = first; i < first + count; ++i) {
            const uint32_t column = columns[i - first];
            size_t left = std::max(column, 1u) - 1, at = column, right = std::min(column + 1, columns_ - 1);
            left *= 3, at *= 3, right *= 3;
            for (size_t k = 0; k < 3; ++k, ++left, ++at, ++right) {
                if (orientation == Orientation::kHorizontal) {
                    u[k][i] = here[right] - here[at];
                    v[k][i] = across_rows * ((below[at] - before[at]) + (below[right] - before[right]));
                } else if (orientation == Orientation::kVertical) {
                    const float across_columns = right - left == 6 ? 0.25f : 0.5f;
                    u[k][i] = across_columns * ((here[right] - here[left]) + (below[right] - below[left]));
                    v[k][i] = below[at] - here[at];
                } else {
                    u[k][i] = 0.5f * ((here[right] - here[at]) + (below[right] - below[at]));
                    v[k][i] = 0.5f * ((below[at] - here[at]) + (below[right] - here[right]));
                }
            }
        }
    }

    template <size_t N>
    void make_frames(DetailLanes<N>& lanes, size_t count) const {
        gim::make_frames(lanes, count, cell_area_);
    }

  private:
    const float* row_at(uint32_t row) const { return image_ + size_t{row} * columns_ * 3; }

    const float* image_;
    uint32_t columns_, rows_;
    float cell_area_;
};

// Quantizer steps of a detail's components.
inline float normal_step(const DetailSteps& steps, Orientation orientation, float scale) {
    return steps.of(orientation) * scale;
}
inline float tangential_step(const DetailSteps& steps, Orientation orientation) {
    return steps.of(orientation) * steps.tangential;
}
inline void steps_in(const DetailFrame& frame, const DetailSteps& steps, Orientation orientation, float* step) {
    step[0] = normal_step(steps, orientation, frame.scale);
    step[1] = step[2] = tangential_step(steps, orientation);
}

// From components along the axes to x, y, z, and back.
inline float dot(float a0, float b0, float a1, float b1, float a2, float b2) { return (a0 * b0 + a1 * b1) + a2 * b2; }
inline void out_of_frame(const DetailFrame& frame, const float* local, float* detail) {
    for (int k = 0; k < 3; ++k)
        detail[k] = dot(frame.axis[0][k], local[0], frame.axis[1][k], local[1], frame.axis[2][k], local[2]);
}
inline void into_frame(const DetailFrame& frame, const float* detail, float* local) {
    for (int k = 0; k < 3; ++k)
        local[k] = dot(frame.axis[k][0], detail[0], frame.axis[k][1], detail[1], frame.axis[k][2], detail[2]);
}

}  // namespace gim
