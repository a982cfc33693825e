// Makes the corrections at a chart's border fade out into the chart.  spec/gim-format.md, "Charts".
// After: Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5.
#pragma once

#include <cstdint>
#include <span>

namespace gim {

// The depth of a sample: kOnBorder, steps to the border as far as they are known, kInside, kUndefined.
inline constexpr uint8_t kOnBorder = 0, kInside = 254, kUndefined = 255;

// How many layers of samples inside a border get a part of its corrections.
uint32_t chart_diffusion_width(uint32_t columns, uint32_t rows);

// A chart's box, row-major. The arrays belong to the caller.
struct ChartRamp {
    uint32_t columns = 0, rows = 0;
    uint8_t* depth = nullptr;
    float* corrections = nullptr;  // triples
    float* samples = nullptr;      // triples
};

// Spreads the corrections inwards, layer by layer. Each sample gets a part of the mean over its neighbours that lie one
// step nearer to the border. Afterwards `depth` counts the layers. border: the chart's border samples, corrected
// already. queue: room for a number per sample of the box. O(samples).
void spread_corrections(const ChartRamp& chart, std::span<const uint32_t> border, uint32_t* queue);

}  // namespace gim
