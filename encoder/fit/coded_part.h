// The parts of an image that are coded one by one, each with a wavelet of its own: a square, or the boxes of charts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/surface/mesh.h"
#include "format/seam.h"

namespace gim {

// A part of an image that is coded by itself: all of a square, or the box of a chart.
struct CodedPart {
    uint32_t columns = 0, rows = 0;
    int32_t column = 0, row = 0;       // of its first sample, in the image; a box may begin outside
    const SeamTable* seams = nullptr;  // of a square whose mates share their details
    std::vector<uint8_t> defined;      // per sample; empty: all are

    size_t sample_count() const { return size_t{columns} * rows; }
    // Returns the sample of an image of this width that a sample of the part is; kNone if it is not defined.
    uint32_t in_image(uint32_t width, uint32_t part_row, uint32_t part_column) const {
        if (!defined.empty() && !defined[size_t{part_row} * columns + part_column]) return kNone;
        return static_cast<uint32_t>(row + static_cast<int32_t>(part_row)) * width +
               static_cast<uint32_t>(column + static_cast<int32_t>(part_column));
    }
    // Calls body(sample of the part, sample of the image) for every defined sample.
    template <class Body>
    void for_each_defined(uint32_t width, const Body& body) const {
        for (uint32_t r = 0; r < rows; ++r) {
            for (uint32_t c = 0; c < columns; ++c) {
                const uint32_t sample = in_image(width, r, c);
                if (sample != kNone) body(size_t{r} * columns + c, size_t{sample});
            }
        }
    }
};

}  // namespace gim
