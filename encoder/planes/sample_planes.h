// What the input looks like at the texels of an image: the step between a fitted geometry image and its attribute planes.
//
// Fitting slides samples along the surface, so a plane cannot be sampled through the parametrization: a texel belongs to the
// point that the image's own triangles have there, and takes the attributes of the closest point of the input. Thin sheets
// have two sides that are both near: one whose face looks the other way is not taken when a search from further outside finds
// a better one. After: Cohen, Olano, Manocha. Appearance-Preserving Simplification. SIGGRAPH 1998 (maps for a surface that
// is not the input's); Gu, Gortler, Hoppe. Geometry Images. 2002. Section 3 (attributes at their own resolution).
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

    // The input's point for every texel. O(texels log F).
    std::vector<ClosestPoint> locate(std::span<const Texel> texels) const;

    // Unit normals, one triple per point: interpolated within a face, with corners that are smooth over edges bent by less
    // than kCreaseAngle and sharp over others.
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
