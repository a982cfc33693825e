// The closing of seams as a linear map (close_chart_seams.h), and its transpose. The fit to the codec needs both.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/chart_levels.h"

namespace gim {

class ChartRamps {
  public:
    // Keeps a reference to the charts. O(samples).
    explicit ChartRamps(const ChartLevels& charts);

    // Applies the transpose to interleaved triples of the samples of charts.image. O(samples).
    void transpose(std::vector<float>& image) const;

  private:
    // A sample inside a chart: its correction is `weight` times the sum of those of its neighbours.
    struct Inner {
        uint32_t sample;  // of the image
        float weight;
        uint32_t neighbours;  // the end of its neighbours; they begin where those before it end
    };
    void add_chart(size_t chart);

    const ChartLevels& charts_;
    std::vector<Inner> inner_;  // chart after chart, from the border inwards
    std::vector<uint32_t> neighbours_;
};

}  // namespace gim
