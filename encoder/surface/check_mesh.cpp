#include "encoder/surface/check_mesh.h"

#include <cmath>
#include <string>

#include "encoder/surface/describe_mesh.h"
#include "encoder/surface/mesh.h"

namespace gim {

namespace {

Error error(std::string message) { return Error{Stage::kClean, std::move(message)}; }

Result<void> check_shading(const TriangleMesh& input) {
    const Shading& shading = input.shading;
    if (shading.empty()) return {};
    if (shading.corners.size() != input.triangles.size())
        return error("the mesh's normals must have one entry per triangle, or none at all");
    for (const auto& corners : shading.corners) {
        for (const uint32_t n : corners) {
            if (n != Shading::kFlat && n >= shading.normals.size())
                return error("a corner of a triangle has a normal that is not there");
        }
    }
    return {};
}

}  // namespace

Result<void> check_numbers(const TriangleMesh& input) {
    if (input.triangles.empty()) return error("the mesh has no triangles; is the file a point cloud, or empty?");
    if (input.positions.size() >= kNone / 4 || input.triangles.size() >= kNone / 4) {
        return error("the mesh is too large: " + std::to_string(input.triangles.size()) +
                     " triangles; simplify it first");
    }
    uint64_t bad = 0;
    size_t first_bad = 0;
    for (size_t v = input.positions.size(); v-- > 0;) {
        const Point& p = input.positions[v];
        if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
        ++bad;
        first_bad = v;
    }
    if (bad > 0) {
        return error(count_of(bad, "vertex has", "vertices have") +
                     " coordinates that are not finite numbers, the first is vertex " + std::to_string(first_bad) +
                     " at " + text_of(input.positions[first_bad]) + "; repair or remove them");
    }
    for (size_t f = input.triangles.size(); f-- > 0;) {
        for (const uint32_t v : input.triangles[f]) {
            if (v < input.positions.size()) continue;
            ++bad;
            first_bad = f;
            break;
        }
    }
    if (bad > 0) {
        const Triangle& t = input.triangles[first_bad];
        return error(count_of(bad, "triangle uses", "triangles use") +
                     " vertices that do not exist, the first is triangle " + std::to_string(first_bad) + " (" +
                     std::to_string(t[0]) + ", " + std::to_string(t[1]) + ", " + std::to_string(t[2]) +
                     ") of a mesh of " + std::to_string(input.positions.size()) + " vertices; the file is damaged");
    }
    return check_shading(input);
}

}  // namespace gim
