// The frame that a lossy detail vector of positions is coded in: the normal and two tangents of the coarser image where
// the detail belongs, and how its quantizer steps follow the area there.  spec/gim-format.md, "Frames".
//
// After: Zorin, Schroeder, Sweldens. Interactive Multiresolution Mesh Editing. 1997 (details in local frames);
// Khodakovsky, Guskov. Compression of Normal Meshes. 2003 (tangential details quantized more coarsely). Where the image
// spreads few samples over much surface, an error of one sample is an error of much surface: steps shrink there.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "format/band_code.h"
#include "format/container.h"
#include "format/lifting.h"

namespace gim {

// How the details of one wavelet step are quantized. Without frames x, y, z have the same step: attribute planes.
struct DetailSteps {
    float edge = 1, diagonal = 1;  // normal steps of the bands high in one direction and in both, where scale is 1
    bool in_frames = false;
    float tangential = 1;  // tangential over normal step
    float cell_area = 0;   // units^2, of a cell of the small image where scale is 1; 0: scale is 1 everywhere

    float of(Orientation orientation) const { return orientation == Orientation::kDiagonal ? diagonal : edge; }
};

// The same of all steps of an image.
struct DetailCoding {
    float quantizer = 0;  // units
    bool in_frames = false;
    float tangential = 1;
    float cell_area = 0;  // of the image at full resolution

    // depth: 1 for the finest bands.
    DetailSteps steps_at(uint32_t depth) const {
        return {band_step(quantizer, depth, Orientation::kHorizontal),
                band_step(quantizer, depth, Orientation::kDiagonal), in_frames, tangential,
                cell_area * static_cast<float>(uint64_t{1} << (2 * depth))};
    }
};

// That of the positions of a lossy file.
inline DetailCoding detail_coding_of(const Header& header) {
    return {header.quantizer, header.tangential > 0, static_cast<float>(header.tangential) / 8,
            cell_area_of(header.cell_area)};
}

inline CoefficientKind coefficient_kind_of(const Header& header) {
    return header.tangential > 0 ? CoefficientKind::kInFrames : CoefficientKind::kPlain;
}

struct DetailFrame {
    float axis[3][3];  // unit normal, unit tangent along the row, unit tangent across; right-handed
    float scale;       // of the normal step
};

inline constexpr float kMostAreaRatio = 4096;        // scale: 1/8 .. 8
inline constexpr uint32_t kLeastScaledSide = 9;      // of small images that tell something about area
inline constexpr float kLargestFrameUnit = 0x1p40f;  // greater tangents make no frame

// The small image that details are added to: rows * columns triples in units.
class FrameField {
  public:
    FrameField(const float* image, uint32_t columns, uint32_t rows, float cell_area)
        : image_(image),
          columns_(columns),
          rows_(rows),
          cell_area_(std::min(columns, rows) < kLeastScaledSide ? 0 : cell_area) {}

    // Of the detail of that band at (row, column): between its sample of the small image and the next one in the
    // direction of high frequency.
    DetailFrame at(Orientation orientation, uint32_t row, uint32_t column) const {
        const uint32_t below = std::min(row + 1, rows_ - 1), right = std::min(column + 1, columns_ - 1);
        float u[3], v[3];
        switch (orientation) {
            case Orientation::kHorizontal:
                difference(row, column, row, right, u);
                across_rows(row, column, right, v);
                break;
            case Orientation::kVertical:
                across_columns(row, below, column, u);
                difference(row, column, below, column, v);
                break;
            case Orientation::kDiagonal: {
                float other[3];
                difference(row, column, row, right, u);
                difference(below, column, below, right, other);
                for (int k = 0; k < 3; ++k) u[k] = 0.5f * (u[k] + other[k]);
                difference(row, column, below, column, v);
                difference(row, right, below, right, other);
                for (int k = 0; k < 3; ++k) v[k] = 0.5f * (v[k] + other[k]);
            }
        }
        return frame_of(u, v);
    }

  private:
    const float* sample(uint32_t row, uint32_t column) const { return image_ + (size_t{row} * columns_ + column) * 3; }
    void difference(uint32_t row0, uint32_t column0, uint32_t row1, uint32_t column1, float* out) const {
        const float *a = sample(row0, column0), *b = sample(row1, column1);
        for (int k = 0; k < 3; ++k) out[k] = b[k] - a[k];
    }
    // Mean over two columns of the tangent along the column, from the rows before and behind where they exist.
    void across_rows(uint32_t row, uint32_t column0, uint32_t column1, float* out) const {
        const uint32_t before = row > 0 ? row - 1 : 0, behind = std::min(row + 1, rows_ - 1);
        mean_tangent(before, column0, behind, column0, before, column1, behind, column1, behind - before == 2, out);
    }
    void across_columns(uint32_t row0, uint32_t row1, uint32_t column, float* out) const {
        const uint32_t before = column > 0 ? column - 1 : 0, behind = std::min(column + 1, columns_ - 1);
        mean_tangent(row0, before, row0, behind, row1, before, row1, behind, behind - before == 2, out);
    }
    void mean_tangent(uint32_t r0, uint32_t c0, uint32_t r1, uint32_t c1, uint32_t r2, uint32_t c2, uint32_t r3,
                      uint32_t c3, bool over_two, float* out) const {
        float first[3], second[3];
        difference(r0, c0, r1, c1, first);
        difference(r2, c2, r3, c3, second);
        const float weight = over_two ? 0.25f : 0.5f;
        for (int k = 0; k < 3; ++k) out[k] = weight * (first[k] + second[k]);
    }

    static float length(const float* a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }
    static void cross(const float* a, const float* b, float* out) {
        out[0] = a[1] * b[2] - a[2] * b[1];
        out[1] = a[2] * b[0] - a[0] * b[2];
        out[2] = a[0] * b[1] - a[1] * b[0];
    }

    DetailFrame frame_of(const float* u, const float* v) const {
        float normal[3];
        cross(u, v, normal);
        const float area = length(normal), along = length(u);
        // False for what is not a number, too.
        if (!(area > 0x1p-40f && along > 0x1p-40f && area < kLargestFrameUnit && along < kLargestFrameUnit))
            return {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, 1};
        DetailFrame frame;
        for (int k = 0; k < 3; ++k) {
            frame.axis[0][k] = normal[k] / area;
            frame.axis[1][k] = u[k] / along;
        }
        cross(frame.axis[0], frame.axis[1], frame.axis[2]);
        frame.scale = 1;
        if (cell_area_ > 0) {
            const float ratio = std::min(std::max(cell_area_ / area, 1 / kMostAreaRatio), kMostAreaRatio);
            frame.scale = std::sqrt(std::sqrt(ratio));
        }
        return frame;
    }

    const float* image_;
    uint32_t columns_, rows_;
    float cell_area_;
};

// Steps of the components of a detail.
inline void steps_in(const DetailFrame& frame, const DetailSteps& steps, Orientation orientation, float* step) {
    step[0] = steps.of(orientation) * frame.scale;
    step[1] = step[2] = steps.of(orientation) * steps.tangential;
}

// Components along the axes -> x, y, z, and back.
inline void out_of_frame(const DetailFrame& frame, const float* local, float* detail) {
    for (int k = 0; k < 3; ++k)
        detail[k] = (frame.axis[0][k] * local[0] + frame.axis[1][k] * local[1]) + frame.axis[2][k] * local[2];
}
inline void into_frame(const DetailFrame& frame, const float* detail, float* local) {
    for (int k = 0; k < 3; ++k)
        local[k] = (frame.axis[k][0] * detail[0] + frame.axis[k][1] * detail[1]) + frame.axis[k][2] * detail[2];
}

}  // namespace gim
