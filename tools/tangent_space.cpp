#include "tools/tangent_space.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "format/cell.h"

namespace gim {
namespace {

using Vec3 = Eigen::Vector3d;

Vec3 triple(const std::vector<float>& values, size_t i, size_t width = 3) {
    return {values[i * width], values[i * width + 1], values[i * width + 2]};
}

Vec3 any_perpendicular(const Vec3& n) {
    const Vec3 axis = std::abs(n.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
    return n.cross(axis).normalized();
}

// As write_glb does: a surface without a normal gets any.
Vec3 normal_or_any(const std::vector<float>& normals, size_t i) {
    const Vec3 n = triple(normals, i);
    return n.squaredNorm() > 0 ? n : Vec3::UnitZ();
}

// The frame of a texel: that of the grid's triangles, interpolated.
class Frames {
  public:
    Frames(const DecodedImage& image, const std::vector<float>& tangents) : image_(image), tangents_(tangents) {}

    // The direction in the frame at (row, column), 0 .. side-1 each.
    Vec3 local(double row, double column, const Vec3& direction) const {
        const CellPoint place = locate_in_cell(image_.side, row, column);
        const std::array<uint32_t, 4>& corners = place.corners;
        // Where the cell is split from first to last sample, both its triangles have these two.
        const uint32_t* triangle = &image_.grid_triangles[size_t{place.cell} * 6];
        const bool main = std::find(triangle, triangle + 3, corners[0]) != triangle + 3 &&
                          std::find(triangle, triangle + 3, corners[3]) != triangle + 3;
        const std::array<double, 4> w = place.weights(main);
        Vec3 n = Vec3::Zero(), t = Vec3::Zero();
        for (size_t i = 0; i < 4; ++i) {
            n += w[i] * normal_or_any(image_.grid_normals, corners[i]);
            t += w[i] * triple(tangents_, corners[i], 4);
        }
        n = n.squaredNorm() > 0 ? n.normalized() : Vec3::UnitZ();
        t = t.squaredNorm() > 0 ? t.normalized() : any_perpendicular(n);
        // Interpolated, the two are no longer quite perpendicular: solve for the weights that the renderer will use.
        const Vec3 b = -n.cross(t);
        Eigen::Matrix3d frame;
        frame << t, b, n;
        if (std::abs(frame.determinant()) < 1e-3) return Vec3::UnitZ();
        return frame.inverse() * direction;
    }

  private:
    const DecodedImage& image_;
    const std::vector<float>& tangents_;
};

}  // namespace

std::vector<float> grid_tangents(const DecodedImage& image) {
    const uint32_t side = image.side;
    std::vector<float> tangents;
    tangents.reserve(size_t{4} * side * side);
    for (uint32_t row = 0; row < side; ++row) {
        for (uint32_t column = 0; column < side; ++column) {
            const size_t i = size_t{row} * side + column;
            const Vec3 n = normal_or_any(image.grid_normals, i).normalized();
            const Vec3 along =
                triple(image.grid, column + 1 < side ? i + 1 : i) - triple(image.grid, column > 0 ? i - 1 : i);
            Vec3 t = along - n * n.dot(along);
            t = t.norm() > 1e-6 * along.norm() ? t.normalized() : any_perpendicular(n);
            for (const double x : {t.x(), t.y(), t.z(), -1.0}) tangents.push_back(static_cast<float>(x));
        }
    }
    return tangents;
}

std::vector<uint8_t> tangent_space_map(const DecodedImage& image, const std::vector<float>& tangents,
                                       const ImagePlane& normals) {
    const Frames frames(image, tangents);
    const double scale = double(image.side - 1) / (normals.side - 1);
    std::vector<uint8_t> rgb;
    rgb.reserve(normals.values.size());
    for (uint32_t row = 0; row < normals.side; ++row) {
        for (uint32_t column = 0; column < normals.side; ++column) {
            const Vec3 n = triple(normals.values, size_t{row} * normals.side + column);
            Vec3 local = frames.local(row * scale, column * scale, n);
            local.z() = std::max(local.z(), 0.0);  // a renderer shows nothing that looks inwards
            local = local.norm() > 1e-6 ? local.normalized() : Vec3::UnitZ();
            for (int k = 0; k < 3; ++k) rgb.push_back(static_cast<uint8_t>(std::lround(127.5 * (1 + local[k]))));
        }
    }
    return rgb;
}

}  // namespace gim
