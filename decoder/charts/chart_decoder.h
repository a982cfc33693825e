// One level of a multi-chart image: borders and streams -> samples of every chart -> zippered charts.
// spec/gim-format.md, "Charts".
// After: Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5. Lossy coding moves
// both sides of a seam: each point becomes the mean of its samples, and the correction fades out into the charts.
#pragma once

#include <cstdint>
#include <span>

#include "decoder/pyramid/arena.h"
#include "decoder/pyramid/pyramid_decoder.h"
#include "format/chart_border.h"
#include "format/chart_ramp.h"
#include "format/chart_table.h"
#include "format/container.h"

namespace gim {

// Sizes of one level, from the chart table alone.
struct ChartLevelShape {
    uint32_t level = 0;
    uint32_t chart_count = 0, path_count = 0;
    uint64_t samples = 0, low_samples = 0;  // of all boxes at this level, and at the next coarser one
    uint32_t widest = 0;                    // columns of the widest box at this level
    uint32_t columns = 0, rows = 0;         // of the level's grid, in which the charts lie
    LevelSize size;
};

// One chart at one level. Its samples are the `columns` x `rows` from flat index `first` on.
struct DecodedChart {
    ChartBox box;
    uint32_t columns = 0, rows = 0;
    uint32_t grid_column = 0, grid_row = 0;  // of its first sample in the level's grid; modulo 2^32: may lie outside
    uint32_t first = 0;
    BorderChart border;
};

// Arrays of a level in the caller's scratch.
struct ChartWorkspace {
    PyramidWorkspace pyramid;  // bands and images hold those of all charts, one after the other
    DecodedChart* charts = nullptr;
    BorderPath* paths = nullptr;
    uint32_t* mates = nullptr;
    BorderModels* border_models = nullptr;
    // Per sample of all boxes:
    uint32_t* border = nullptr;  // border samples, chart after chart
    uint32_t* point = nullptr;   // vertex of the glued surface; unspecified where undefined
    uint8_t* depth = nullptr;    // kOnBorder, steps to the border as far as they are known, kInside, kUndefined
    uint32_t* queue = nullptr;
    float* corrections = nullptr;  // triples; takes the place of the bands
    // Per vertex:
    uint32_t* members = nullptr;
    float* sums = nullptr;  // triples
};

Status open_charts(const Header& header, std::span<const uint8_t> file, const ContainerLimits& limits, uint32_t level,
                   ChartLevelShape* shape);

ChartWorkspace lay_out_charts(const ChartLevelShape& shape, Arena* arena);

// Decodes and zips. *samples receives flat triples in units.
Status decode_charts(const Header& header, std::span<const uint8_t> file, const ContainerLimits& limits,
                     const ChartLevelShape& shape, const ChartWorkspace& ws, const float** samples);

}  // namespace gim
