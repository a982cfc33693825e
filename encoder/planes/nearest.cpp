#include "gim/nearest.h"

#include "encoder/planes/input_triangles.h"
#include "encoder/planes/sample_planes.h"

namespace gim {
namespace {

Vec3 vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

struct NearestPoints::Impl {
    Impl(const TriangleMesh& input, uint32_t threads)
        : mesh(triangles_with_area(input, &triangles)), source(mesh, threads) {}

    std::vector<uint32_t> triangles;  // of the input
    Mesh mesh;
    AttributeSource source;
};

NearestPoints::NearestPoints(const TriangleMesh& mesh, uint32_t threads)
    : impl_(std::make_unique<Impl>(mesh, threads)) {}
NearestPoints::~NearestPoints() = default;
NearestPoints::NearestPoints(NearestPoints&&) noexcept = default;

std::vector<SurfacePoint> NearestPoints::find(std::span<const SurfaceQuery> queries) const {
    std::vector<SurfacePoint> points(queries.size());
    if (impl_->triangles.empty()) return points;
    std::vector<Texel> texels;
    texels.reserve(queries.size());
    for (const SurfaceQuery& query : queries)
        texels.push_back({0, vector_of(query.position), vector_of(query.outside), query.spacing});
    const std::vector<ClosestPoint> found = impl_->source.locate(texels);
    for (size_t i = 0; i < points.size(); ++i) points[i] = {impl_->triangles[found[i].triangle], found[i].barycentric};
    return points;
}

}  // namespace gim
