// Which samples and cells of an image change when one wavelet detail of it changes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/fit/coded_image.h"
#include "encoder/image/gluing.h"

namespace gim {

struct DetailReach {
    WeightedSamples samples;      // those that move
    std::vector<uint32_t> cells;  // those at them that count
    WeightedSamples corners;      // those that move and are corners of the cells
};

class ReachFinder {
  public:
    // Keeps a reference to gluing.
    explicit ReachFinder(const GridGluing& gluing);

    // Returns what a detail moves after samples at one surface point went to their mean. moved: as CodedImage says. The
    // cells that count are those whose margin is at most `most`. margin: per cell. The reference holds until the next
    // call. O(samples that move).
    const DetailReach& find(const WeightedSamples& moved, std::span<const double> margin, double most);

  private:
    void add_sample(uint32_t v, float weight);
    void spread_over_classes();

    const GridGluing& gluing_;
    DetailReach reach_;
    // Marks of the last search, so that nothing needs clearing.
    uint32_t stamp_ = 0;
    std::vector<uint32_t> sample_stamp_, sample_slot_, corner_stamp_, cell_stamp_;
};

}  // namespace gim
