// What a layout tells about the planes of its images: where their texels lie on the surface, and how values become bands.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "encoder/image/geometry_image.h"

namespace gim {

// A texel that lies on the image's surface.
struct Texel {
    uint32_t index = 0;  // in its plane, row-major
    Vec3 position = Vec3::Zero(), outside = Vec3::Zero();
    double spacing = 0;  // of the samples around it
};

struct TexelGrid {
    uint32_t columns = 0, rows = 0;
    std::vector<Texel> texels;
};

class PlaneImages {
  public:
    virtual ~PlaneImages() = default;
    // Per image how fine its plane is, as the file counts it: `side` texels a side for the largest square, or for a square
    // of as many samples.
    virtual std::vector<uint8_t> plane_exponents(uint32_t side) const = 0;
    virtual TexelGrid texel_grid(size_t image, uint8_t exponent) const = 0;
    // values: a triple per texel of the plane, 0 where it is not on the surface. quantizer: of the plane, in its units.
    virtual Pyramid<float> analyse_plane(size_t image, const TexelGrid& grid, std::vector<float> values,
                                         float quantizer) const = 0;
};

// Per sample the unit normal of the surface around its point, by area; zero where there is none.
std::vector<Vec3> outside_directions(const GeometryImage& image);

// Unit length, or zero.
inline Vec3 unit_or_zero(const Vec3& v) {
    const double length = v.norm();
    return length > 0 ? Vec3(v / length) : Vec3::Zero();
}

}  // namespace gim
