// What a layout knows about the planes of its images: where texels lie on the surface, and how values become bytes.
#pragma once

#include <cstdint>
#include <functional>
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

// Codes one plane of one image to its stream. quantizer: in units of the plane, as the file says it.
using PlaneCoder = std::function<std::vector<uint8_t>(float quantizer)>;

class PlaneImages {
  public:
    virtual ~PlaneImages() = default;
    // Returns how fine the plane of each image is, as an exponent in the file. `side`: texels per side for the largest
    // square, or for a square with as many samples as the image.
    virtual std::vector<uint8_t> plane_exponents(uint32_t side) const = 0;
    virtual TexelGrid texel_grid(size_t image, uint8_t exponent) const = 0;
    // values: a triple per texel of the plane, 0 if it is not on the surface. quantizer: about what it will be coded with.
    virtual PlaneCoder analyse_plane(size_t image, const TexelGrid& grid, std::vector<float> values,
                                     float quantizer) const = 0;
};

// The coder of a plane that is one pyramid.
PlaneCoder coder_of(Pyramid<float> pyramid);

// Returns the area-weighted unit normal of the surface at each sample; zero if it has none.
std::vector<Vec3> outside_directions(const GeometryImage& image);

// Returns v at length 1, or zero if v is zero.
inline Vec3 unit_or_zero(const Vec3& v) {
    const double length = v.norm();
    return length > 0 ? Vec3(v / length) : Vec3::Zero();
}

}  // namespace gim
