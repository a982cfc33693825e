// One level of an attribute plane, ready to be decoded.
#pragma once

#include <cstdint>

#include "decoder/pyramid/arena.h"
#include "decoder/pyramid/pyramid_decoder.h"
#include "format/plane_code.h"
#include "format/seam.h"

namespace gim {

struct PlaneLevel {
    PlaneChunk chunk;
    PyramidShape shape;  // squares and charts
    SeamTable seams;     // squares only
    uint32_t width = 0, height = 0, coarsest = 0;
    uint64_t prefix = 0;  // bytes of the file, from its start, that the plane needs
};

}  // namespace gim
