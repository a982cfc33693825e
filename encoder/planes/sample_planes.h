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

#include "encoder/base/result.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/image/geometry_image.h"
#include "encoder/surface/closest_point.h"

namespace gim {

// The clean input, prepared for many images and planes.
class AttributeSource {
  public:
    // Keeps a reference to the mesh.
    explicit AttributeSource(const Mesh& mesh, uint32_t threads = 0);

    // The input's point for every texel of a side x side plane of the image, row-major. Fails on inconsistent seams.
    // O(side^2 log F).
    Result<std::vector<ClosestPoint>> locate(const GeometryImage& image, uint32_t side) const;

    // Of charts, 2^exponent texels a sample: only those that lie in a triangle, told by their numbers in the plane, row-major.
    struct Texels {
        std::vector<uint32_t> texels;
        std::vector<ClosestPoint> points;
    };
    Result<Texels> locate(const MultiChartImage& image, uint32_t exponent) const;

    // Unit normals, one triple per point: interpolated within a face, with corners that are smooth over edges bent by less
    // than kCreaseAngle and sharp over others.
    std::vector<float> normals(std::span<const ClosestPoint> points) const;
    Vec3 normal(const ClosestPoint& point) const;

    const Mesh& mesh() const { return mesh_; }

    static constexpr double kCreaseAngle = 60;  // degrees

  private:
    // A point of the image's surface.
    struct Query {
        Vec3 position = Vec3::Zero(), outside = Vec3::Zero();
        double spacing = 0;  // of samples around it
    };
    std::vector<ClosestPoint> locate(const std::vector<Query>& queries) const;

    Vec3 face_normal(uint32_t face) const;
    void keep_to_the_right_side(const Vec3& query, const Vec3& outside, double spacing, ClosestPoint* found) const;

    const Mesh& mesh_;
    ClosestPointTree tree_;
    std::vector<Vec3> corner_normals_;  // 3 per face
    uint32_t threads_;
};

// Values of all members of a class become those of its first one. values: side*side triples.
Result<bool> equalize_ring(const Sideband& sideband, uint32_t side, std::vector<float>& values);

}  // namespace gim
