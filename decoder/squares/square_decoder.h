// Samples of one level of one image: streams -> bands -> inverse wavelet -> unit positions -> closed seams.
// A "unit" is one quantization step; position = origin + step * unit value.
#pragma once

#include <cstdint>
#include <span>

#include "decoder/pyramid/arena.h"
#include "decoder/pyramid/pyramid_decoder.h"
#include "decoder/squares/triangulate.h"
#include "format/container.h"
#include "format/fuse.h"
#include "format/seam.h"

namespace gim {

// Memory to decode a square and to make the two sides of its seams equal, in the caller's scratch.
struct PlaneWorkspace {
    PyramidWorkspace pyramid;
    uint32_t* class_of = nullptr;
    FuseWork fuse;
};

// Everything that decoding one level of an image needs.
struct ImageWorkspace : PlaneWorkspace {
    float* normals = nullptr;
    TriangulateWork triangulate = {};
};

// The pyramid of a square of side 2^exponent + 1.
inline PyramidShape square_shape(uint32_t exponent, uint32_t level, const DetailCoding& details, int32_t middle,
                                 const SeamTable* seams = nullptr) {
    const uint32_t side = (1u << exponent) + 1;
    return {side, side, exponent, level, details, middle, false, seams};
}

// side: of the requested level.
PlaneWorkspace lay_out_plane(uint32_t side, Arena* arena);
ImageWorkspace lay_out(uint32_t side, Arena* arena);

// Decodes and fuses the samples of a level: floats in units in ws.pyramid.images[0]. Fills ws.class_of.
Status decode_level(const Header& header, std::span<const uint8_t> file, uint32_t image, uint32_t level,
                    const SeamTable& seams, const ImageWorkspace& ws, float** samples);

// Reads and checks the sideband of one image. Returns kMalformed also if the finest level is not closed.
Status read_seams(const Header& header, std::span<const uint8_t> file, uint32_t image, SeamTable* seams);

}  // namespace gim
