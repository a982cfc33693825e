// What the values around a triple let expect of its magnitudes.  spec/gim-format.md, "Values".
// All that is known before a row is coded is weighed for the whole row at once, so that compilers can vectorise it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/band.h"
#include "format/rim.h"
#include "format/trained_models.h"

namespace gim {

inline uint32_t magnitude_of(int32_t v) { return static_cast<uint32_t>(v < 0 ? -v : v); }

// Blocks of 8x8 triples beside each other; those that are all zero are not coded.
inline constexpr uint32_t block_count(uint32_t columns) { return (columns + 7) / 8; }

// What is known besides the band itself: the band above in the pyramid and those of the same level coded before.
struct BandSurroundings {
    Orientation orientation = Orientation::kHorizontal;
    const Band* parent = nullptr;
    const Band* horizontal = nullptr;
    const Band* vertical = nullptr;
    const BandWeights* weights = nullptr;  // of the first and of later components
    SharedRim rim;
};

// Rows that a BandCoder works in, in memory of its user; contents undefined before and after. Each begins behind a triple of
// room and ends before one.
class BandWork {
  public:
    BandWork() = default;
    // memory: size(columns) numbers, or null while memory is counted; columns: of the widest image.
    BandWork(uint32_t* memory, uint32_t columns);
    static size_t size(uint32_t columns);

    uint32_t* magnitudes = nullptr;  // of the row above, then of this row
    uint32_t* expected = nullptr;    // of this row, without what its own triples tell
    // What the parent band, the horizontal and the vertical band have around each triple.
    uint32_t *parents = nullptr, *horizontal = nullptr, *vertical = nullptr;
    uint32_t* full_above = nullptr;  // a flag per block: is it not empty?
};

// With memory of its own.
class OwnBandWork {
  public:
    explicit OwnBandWork(uint32_t columns) : memory_(BandWork::size(columns)), columns_(columns) {}
    BandWork view() { return {memory_.data(), columns_}; }

  private:
    std::vector<uint32_t> memory_;
    uint32_t columns_;
};

// Fills in work.expected for columns begin .. end-1 of a row: whole blocks, or up to the band's end. Rows of one row of blocks
// come in order.
void expect(const BandSurroundings& around, uint32_t row, uint32_t begin, uint32_t end, const BandWork& work);

}  // namespace gim
