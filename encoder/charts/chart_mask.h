// Finds the samples that a chart occupies at a given scale and orientation: rasterises its interior and border, and
// dilates until the discrete chart is a disk.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.4.
//
// A sample is defined if it lies inside the chart's border or within half a sample of it. Three or four defined samples
// of a 2 x 2 quad make triangles (section 3 of the paper). Dilation defines further samples until the triangles around
// every defined sample form exactly one fan. We differ from the paper: (1) A mask says whether it is a disk. If it is
// not, the caller can choose another orientation or scale. (2) Holes of a few samples are filled. (3) Single triangles
// that stick out are cut off, because they make seams hard to close.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

// A small bitmap, one byte per sample.
struct SampleMask {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> defined;  // row-major

    // Returns false outside the rectangle.
    bool at(int64_t column, int64_t row) const {
        return column >= 0 && row >= 0 && column < width && row < height &&
               defined[static_cast<size_t>(row) * width + static_cast<size_t>(column)] != 0;
    }
    uint64_t count() const;
};

// Takes a point of a chart's map to samples: p -> scale * R(angle) p + offset. x is the column, y is the row. Keeps the
// orientation.
struct ChartPose {
    double scale = 1;  // samples per object unit
    double angle = 0;  // radians, counter-clockwise with y upwards, as in the map
    Vec2 offset = Vec2::Zero();

    Vec2 operator()(const Vec2& p) const;
};

struct ChartMask {
    SampleMask mask;             // cropped to the defined samples
    ChartPose pose;              // leads to the mask's own columns and rows
    uint32_t defined = 0;        // samples
    uint32_t border_length = 0;  // border samples
    bool is_disk = false;
};

// Samples outside a chart belong to it up to this distance from its border, in samples. This is the default.
inline constexpr double kBand = 0.5;

// In: the border of a chart's map, counter-clockwise. It must not touch itself. O(area + border), both in samples.
ChartMask rasterize_chart(const std::vector<Vec2>& border, double scale, double angle);
// Does the same with samples at the whole coordinates of `pose`: the result's offset differs from the pose's by whole
// numbers. band: a sample outside the chart belongs to it up to this distance from its border, in samples.
ChartMask rasterize_chart_on_lattice(const std::vector<Vec2>& border, const ChartPose& pose, double band = kBand);
// Crops the rectangle to the defined samples, moves the pose along and counts again. Call it after removing samples.
void trim(ChartMask& chart);

// ---- the triangles of a mask --------------------------------------------------------------------------------------

// Returns whether the quads with three or four defined samples make a 2-manifold with one border loop and no handle or
// hole, and every defined sample is part of it.
bool mask_is_disk(const SampleMask& mask);

// Adds samples until the triangles around every defined sample form one fan. Touches the outermost ring of the
// rectangle only if it has to. A margin of two samples is enough in practice.
void dilate_to_manifold(SampleMask& mask);

// Returns whether a sample is the tip of a single triangle, in a quad of three samples. A disk without it stays one.
bool is_spike(const SampleMask& mask, uint32_t sample);

// Returns whether a disk stays a disk without this border sample.
bool can_remove(const SampleMask& mask, uint32_t sample);

// Returns the border loops of the mask's triangles: samples (row * width + column) in order. The triangles lie on the
// left if x is the column and y is the row. A loop begins with its first sample in row-major order. Loops are sorted by
// their first samples. In: a mask whose samples each have one fan.
std::vector<std::vector<uint32_t>> trace_borders(const SampleMask& mask);

}  // namespace gim
