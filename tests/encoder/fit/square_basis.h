// The basis of a square, for tests.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/fit/parts_basis.h"

namespace gim::test {

// Owns the part that the basis refers to.
struct SquareBasis {
    std::vector<CodedPart> parts;
    PartsBasis basis;

    SquareBasis(const std::vector<float>& image, uint32_t side, const DetailCoding& coding,
                const SeamTable* seams = nullptr)
        : parts{{side, side, 0, 0, seams, {}}}, basis(parts, {image}, side, size_t{side} * side, coding) {}
    SquareBasis(const SquareBasis&) = delete;
    SquareBasis& operator=(const SquareBasis&) = delete;
};

}  // namespace gim::test
