// A complex of tiles that owns its memory.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "format/quad_complex.h"

namespace gim {

class OwnComplex {
  public:
    explicit OwnComplex(uint32_t tiles) : numbers_(5 * size_t{4} * tiles), on_boundary_(size_t{4} * tiles) {
        uint32_t* next = numbers_.data();
        for (uint32_t** array : {&view_.mate, &view_.vertex, &view_.edge, &view_.lower, &view_.valence}) {
            *array = next;
            next += size_t{4} * tiles;
        }
        view_.on_boundary = on_boundary_.data();
        view_.tiles = tiles;
    }
    OwnComplex(OwnComplex&&) noexcept = default;  // the memory stays where it is
    OwnComplex& operator=(OwnComplex&&) noexcept = default;

    const QuadComplex& view() const { return view_; }
    QuadComplex& view() { return view_; }

  private:
    std::vector<uint32_t> numbers_;
    std::vector<uint8_t> on_boundary_;
    QuadComplex view_;
};

}  // namespace gim
