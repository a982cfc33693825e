// The samples that a chart occupies at a given scale and orientation: interior and border rasterisation, and the
// dilation that makes the discrete chart a disk.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.4.
//
// A sample is defined when it lies inside the chart's border or within half a sample of it. Three or four defined
// samples of a 2 x 2 quad make triangles (section 3 of the paper). Dilation defines further samples until the triangles
// around every defined sample form exactly one fan. We differ from the paper in that the result is certified: a mask says
// whether it is a disk, so that the caller can choose another orientation or scale where it is not; in that holes of a few
// samples are filled; and in that single triangles that stick out are cut off, as they make it hard to close the seams.
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

    // False outside the rectangle.
    bool at(int64_t column, int64_t row) const {
        return column >= 0 && row >= 0 && column < width && row < height &&
               defined[static_cast<size_t>(row) * width + static_cast<size_t>(column)] != 0;
    }
    uint64_t count() const;
};

// A chart's map in samples: p -> scale * R(angle) p + offset; column is x, row is y. Orientation is kept.
struct ChartPose {
    double scale = 1;  // samples per object unit
    double angle = 0;  // radians, counter-clockwise with y upwards, as in the map
    Vec2 offset = Vec2::Zero();

    Vec2 operator()(const Vec2& p) const;
};

struct ChartMask {
    SampleMask mask;             // cropped to the defined samples
    ChartPose pose;              // into the mask's own columns and rows
    uint32_t defined = 0;        // samples
    uint32_t border_length = 0;  // border samples
    bool is_disk = false;
};

// How near to its border samples outside belong to a chart, unless told otherwise.
inline constexpr double kBand = 0.5;

// In: the border of a chart's map, counter-clockwise, not touching itself. O(area + border in samples).
ChartMask rasterize_chart(const std::vector<Vec2>& border, double scale, double angle);
// The same with samples where the pose has whole coordinates: the result's offset differs from the pose's by whole numbers.
// band: how near to the border samples outside belong to the chart.
ChartMask rasterize_chart_on_lattice(const std::vector<Vec2>& border, const ChartPose& pose, double band = kBand);
// After samples were taken away: cuts the rectangle down to the others, moves the pose along and counts anew.
void trim(ChartMask& chart);

// ---- the triangles of a mask --------------------------------------------------------------------------------------

// Whether quads with three or four defined samples make a 2-manifold with one border loop and no handle or hole, which
// every defined sample is part of.
bool mask_is_disk(const SampleMask& mask);

// Adds samples until the triangles around every defined sample form one fan. Never touches the outermost ring of the
// rectangle unless it has to; a margin of two samples is enough in practice.
void dilate_to_manifold(SampleMask& mask);

// Whether a sample is the tip of a single triangle, its quad having three samples. A mask that is a disk stays one without it.
bool is_spike(const SampleMask& mask, uint32_t sample);

// Whether a disk stays a disk without this border sample.
bool can_remove(const SampleMask& mask, uint32_t sample);

// Border loops of the mask's triangles: samples (row * width + column) in order, triangles on the left where columns run
// along x and rows along y. A loop begins with its first sample in row-major order; loops come in the order of their
// first samples. In: a mask whose samples each have one fan.
std::vector<std::vector<uint32_t>> trace_borders(const SampleMask& mask);

}  // namespace gim
