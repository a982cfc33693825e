// One level of an attribute plane, ready to be decoded.
#pragma once

#include <cstdint>

#include "decoder/pyramid/arena.h"
#include "decoder/pyramid/pyramid_decoder.h"
#include "format/fuse.h"
#include "format/plane_code.h"
#include "format/seam.h"

namespace gim {

struct PlaneLevel {
    PlaneChunk chunk;
    PyramidShape shape;
    SeamTable seams;  // of squares
    uint32_t width = 0, height = 0, coarsest = 0;
    uint64_t prefix = 0;  // bytes of the file that the plane needs
};

// Memory that decoding a plane and making the two sides of its seams equal needs, laid out in the caller's scratch.
struct PlaneWorkspace {
    PyramidWorkspace pyramid;
    uint32_t* class_of = nullptr;  // of squares, as the next
    FuseWork fuse;
};

}  // namespace gim
