// Finds the input's attributes at the texels of an image: the step from a fitted image to its attribute planes.
//
// Fitting slides samples along the surface, so a plane cannot be sampled through the parametrization. A texel stands
// for a point on the image's own triangles, and takes the attributes of the closest point of the input. On a thin sheet
// both sides are near. If the closest face looks the other way, a search from further outside may find a better one.
// After: Cohen, Olano, Manocha. Appearance-Preserving Simplification. SIGGRAPH 1998 (maps for a surface other than the
// input's); Gu, Gortler, Hoppe. Geometry Images. 2002. Section 3 (attributes at their own resolution).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/planes/plane_images.h"
#include "encoder/surface/closest_point.h"

namespace gim {

// The clean input, prepared for many images and planes.
class AttributeSource {
  public:
    // Keeps a reference to the mesh.
    explicit AttributeSource(const Mesh& mesh, uint32_t threads = 0);

    // Returns the input's point for every texel. O(texels log F).
    std::vector<ClosestPoint> locate(std::span<const Texel> texels) const;

    // Returns unit normals, one triple per point. They are interpolated within a face. Its corners are smooth over
    // edges bent by less than kCreaseAngle and sharp over others.
    std::vector<float> normals(std::span<const ClosestPoint> points) const;
    Vec3 normal(const ClosestPoint& point) const;

    const Mesh& mesh() const { return mesh_; }

    static constexpr double kCreaseAngle = 60;  // degrees

  private:
    Vec3 face_normal(uint32_t face) const;
    void keep_to_the_right_side(const Vec3& query, const Vec3& outside, double spacing, ClosestPoint* found) const;

    const Mesh& mesh_;
    ClosestPointTree tree_;
    std::vector<Vec3> corner_normals_;  // 3 per face
    uint32_t threads_;
};

}  // namespace gim
