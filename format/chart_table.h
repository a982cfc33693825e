// The chart table of a multi-chart image: the size of each chart, its place in the rectangle, the paths of its border,
// and which paths are one curve on the surface.  spec/gim-format.md, "Chart table".
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Sections 3 and 4.5 (sideband).
//
// A chart is an image of its own, in a box somewhat larger than its samples, so that its neighbours in the rectangle do
// not matter for coding it and making it coarser. Each level tells which samples of the box belong to the chart
// (format/chart_border.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "format/bits.h"
#include "format/container.h"
#include "format/mate.h"
#include "format/status.h"

namespace gim {

inline constexpr uint32_t kMaxCharts = 8192;
inline constexpr uint32_t kMaxChartPaths = 16384;  // of all charts; bounds the memory of a ChartTableReader (16 KiB)
inline constexpr uint32_t kMaxChartSide = 32768;

// How often a box can be halved until its shorter side has two samples; at most kMaxLevels.
uint32_t halvings(uint32_t columns, uint32_t rows);

struct ChartBox {
    uint32_t columns = 2, rows = 2;           // at full resolution
    int32_t atlas_column = 0, atlas_row = 0;  // of the box's first sample in the rectangle; may lie outside
    uint32_t path_count = 0;

    // Halvings of the box by the wavelet.
    uint32_t steps() const { return halvings(columns, rows); }
};

// Sizes of a whole level.
struct LevelSize {
    uint32_t vertices = 0, triangles = 0;  // of the glued surface
};

struct ChartTable {
    std::vector<ChartBox> charts;
    std::vector<uint32_t> mates;    // per path, chart after chart: the path on the other side, or kNoMate
    std::vector<LevelSize> levels;  // finest first
};

// Reads the table chart by chart. Trusts no byte and allocates nothing.
class ChartTableReader {
  public:
    // Reads the fields before the charts.
    Status open(std::span<const uint8_t> payload, const Header& header, const ContainerLimits& limits);

    uint32_t chart_count() const { return chart_count_; }
    const LevelSize& level(uint32_t level) const { return levels_[level]; }

    // Reads the next of chart_count() charts. mates: nullptr, or an array of all paths, whose entries for the paths of
    // this chart and for their mates are filled in.
    Status next(ChartBox* chart, uint32_t* mates);
    // Checks, after the last chart, that every path has found its mate and that nothing is left over.
    Status finish();
    uint32_t path_count() const { return path_count_; }  // of the charts so far

  private:
    Status read_paths(uint32_t count, uint32_t* mates);

    BitReader bits_{{}};
    std::array<LevelSize, kMaxLevels> levels_{};
    uint32_t chart_count_ = 0, level_count_ = 0, margin_ = 0, box_bits_ = 0, width_ = 0, height_ = 0;
    uint64_t most_samples_ = 0, samples_ = 0;
    uint32_t path_count_ = 0, open_count_ = 0;
    // Paths that wait for their mate, oldest first. If more than half of all paths wait, some wait in vain.
    std::array<uint16_t, kMaxChartPaths / 2> open_{};
};

std::vector<uint8_t> serialize_chart_table(const ChartTable& table, const Header& header);

}  // namespace gim
