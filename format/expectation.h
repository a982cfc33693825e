// Expects the magnitudes of a triple from the values around it.  spec/gim-format.md, "Values".
// What is known before a row is coded is weighed for the whole row at once, so that compilers vectorise it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/band.h"
#include "format/rim.h"
#include "format/trained_models.h"

namespace gim {

inline uint32_t magnitude_of(int32_t v) { return static_cast<uint32_t>(v < 0 ? -v : v); }

// The number of 8x8 blocks of triples in a row of blocks. Blocks that are all zero are not coded.
inline constexpr uint32_t block_count(uint32_t columns) { return (columns + 7) / 8; }

// What is known besides the band itself: the parent band, and the bands of the same level that are coded before.
struct BandSurroundings {
    Orientation orientation = Orientation::kHorizontal;
    const Band* parent = nullptr;
    const Band* horizontal = nullptr;
    const Band* vertical = nullptr;
    const BandWeights* weights = nullptr;  // two: of the first component and of later ones
    SharedRim rim;
};

// Rows that a BandCoder works in. The caller owns the memory; its contents are undefined before and after. Each row has
// a margin of one triple at either end.
class BandWork {
  public:
    BandWork() = default;
    // memory: size(columns) numbers, or nullptr to only count them. columns: of the widest image.
    BandWork(uint32_t* memory, uint32_t columns);
    static size_t size(uint32_t columns);

    uint32_t* magnitudes = nullptr;  // of the row above, then of this row
    uint32_t* expected = nullptr;    // of this row, without the part that its own triples add
    // What the parent, the horizontal and the vertical band have around each triple.
    uint32_t *parents = nullptr, *horizontal = nullptr, *vertical = nullptr;
    uint32_t* full_above = nullptr;  // per block: 1 if it is not empty
};

// A BandWork that owns its memory.
class OwnBandWork {
  public:
    explicit OwnBandWork(uint32_t columns) : memory_(BandWork::size(columns)), columns_(columns) {}
    BandWork view() { return {memory_.data(), columns_}; }

  private:
    std::vector<uint32_t> memory_;
    uint32_t columns_;
};

// Fills work.expected for columns begin .. end-1 of a row: whole blocks, or up to the band's end. Within a row of
// blocks, rows come in order.
void expect(const BandSurroundings& around, uint32_t row, uint32_t begin, uint32_t end, const BandWork& work);

}  // namespace gim
