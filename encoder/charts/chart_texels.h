// Texels of a plane on packed charts: 2^exponent texels a sample, those that lie in a triangle.
#pragma once

#include <cstdint>

#include "encoder/planes/plane_images.h"

namespace gim {

// How fine a plane is that has as many texels as a square of `side` texels a side has for as many samples.
uint8_t chart_plane_exponent(const GeometryImage& image, uint32_t side);

// Texels in the order of the triangles that they lie in; those on an edge belong to the first. O(texels).
TexelGrid chart_texels(const GeometryImage& image, uint8_t exponent);

// Bands of a plane; texels beyond the charts are chosen so that they cost little. values: a triple per texel.
Pyramid<float> analyse_chart_plane(const TexelGrid& grid, std::vector<float> values, float quantizer);

}  // namespace gim
