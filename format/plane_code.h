// Attribute planes: the fields of their chunks, and how triples of samples stand for normals and colours.
// spec/gim-format.md, "Planes".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/container.h"
#include "format/status.h"

namespace gim {

inline constexpr float kNormalUnit = 1024;  // length of a normal as encoders write it; readers take any

// A plane chunk as stored; the spans point into its payload.
struct PlaneChunk {
    float quantizer = 0;
    std::span<const uint8_t> side_exponents;  // one per image; squares: side = 2^j + 1, else 2^j texels a sample
    std::span<const uint8_t> stream;          // of the image that was asked for

    uint32_t side(uint32_t image) const { return (1u << side_exponents[image]) + 1; }
};

// Kinds of planes, numbered as in gim/decoder.h (0 normals, 1 colours, 2 displacements), and their chunk types.
inline constexpr uint32_t kPlaneKinds = 3;
inline ChunkType plane_type(uint32_t kind) {
    return static_cast<ChunkType>(static_cast<uint32_t>(ChunkType::kNormals) + kind);
}

inline constexpr uint32_t kMaxTexelExponent = 6;  // of planes on charts and on tiles

// Texels along a side of a rectangle of samples.
constexpr uint64_t texels_along(uint32_t rectangle_side, uint32_t exponent) {
    return (uint64_t{rectangle_side - 1} << exponent) + 1;
}

// How a plane with 2^texels texels a sample lies on tiles: as positions of that many steps more, coded with 9/7.
inline TileShape tile_plane_shape(TileShape shape, uint32_t texels) {
    shape.exponent += texels;
    shape.is_sharp = false;
    return shape;
}

// Reads the plane of one image. image < header.image_count().
Status parse_plane(std::span<const uint8_t> payload, const Header& header, uint32_t image,
                   const ContainerLimits& limits, PlaneChunk* plane);

// One exponent and one stream per image.
std::vector<uint8_t> serialize_plane(float quantizer, std::span<const uint8_t> side_exponents,
                                     std::span<const std::vector<uint8_t>> streams);

// Turns a colour into luma and two chroma differences, in place; all are in 1/255 of the range. Errors of equal size in
// the three are about equally bad in the colour.
inline void to_luma(float* c) {
    const float r = c[0], g = c[1], b = c[2];
    c[0] = 0.25f * r + 0.5f * g + 0.25f * b;
    c[1] = 0.5f * (r - b);
    c[2] = 0.5f * g - 0.25f * (r + b);
}
inline void from_luma(float* c) {
    const float y = c[0], o = c[1], g = c[2], rest = y - g;
    c[0] = rest + o;
    c[1] = y + g;
    c[2] = rest - o;
}

}  // namespace gim
