// How an image changes when one wavelet detail changes: the 9/7 synthesis function of the detail, cut to where it
// matters. Functions of equal place relative to the image's ends are computed once.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "format/band.h"

namespace gim {

// A function on a block of samples.
struct ResponseBlock {
    uint32_t row = 0, column = 0;  // of the first sample, in the image
    uint32_t rows = 0, columns = 0;
    const float* weights = nullptr;  // rows * columns, row-major
};

class DetailResponses {
  public:
    // has_rim: of a square whose rim is transformed by itself (format/rim.h).
    DetailResponses(uint32_t columns, uint32_t rows, bool has_rim)
        : columns_(columns), rows_(rows), has_rim_(has_rim) {}

    // Returns the response of the detail at (row, column) of a band. depth: 1 for the finest. Leaves out what is less
    // than `least` of the largest weight. The pointer stays valid. The first call for a kind of place costs a synthesis
    // of a small image. Several threads may call it at once.
    ResponseBlock at(uint32_t depth, Orientation orientation, uint32_t row, uint32_t column);

  private:
    struct Key {
        uint32_t depth, orientation, row, column;
        auto operator<=>(const Key&) const = default;
    };
    struct Kept {
        int32_t row = 0, column = 0;  // of the first sample, relative to the detail's low sample
        uint32_t rows = 0, columns = 0;
        std::vector<float> weights;
    };
    Kept compute(const Key& key, uint32_t small_columns, uint32_t small_rows) const;

    uint32_t columns_, rows_;
    bool has_rim_;
    std::map<Key, Kept> known_;
    std::unique_ptr<std::mutex> guards_known_ = std::make_unique<std::mutex>();
};

}  // namespace gim
