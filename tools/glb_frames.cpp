#include "tools/glb_frames.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

namespace gim::gltf {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d triple(const std::vector<float>& values, size_t i, size_t width = 3) {
    return {double{values[i * width]}, double{values[i * width + 1]}, double{values[i * width + 2]}};
}

Vector3d any_perpendicular(const Vector3d& n) {
    return n.cross(std::abs(n.x()) < 0.6 ? Vector3d::UnitX() : Vector3d::UnitY()).normalized();
}

Vector3d unit_or(const Vector3d& v, const Vector3d& other) { return v.norm() > 1e-12 ? v.normalized() : other; }

Vector3d row_of(const MorphedColumn& column, uint64_t row) {
    return {column.at(row, 0), column.at(row, 1), column.at(row, 2)};
}

}  // namespace

FrameAt frame_at(const PrimitiveArrays& arrays, uint32_t triangle, const std::array<float, 3>& weights) {
    FrameAt at{Vector3d::Zero(), Vector3d::Zero(), Matrix3d::Zero(), 0};
    Vector3d tangent = Vector3d::Zero();
    std::array<Vector3d, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
        const size_t v = arrays.indices[3 * size_t{triangle} + k];
        const double w = double{weights[k]};
        corners[k] = triple(arrays.positions, v);
        at.position += w * corners[k];
        at.normal += w * triple(arrays.normals, v);
        if (!arrays.tangents.empty()) tangent += w * triple(arrays.tangents, v, 4);
    }
    at.normal = unit_or(at.normal, Vector3d::UnitZ());
    at.spacing = std::sqrt((corners[1] - corners[0]).cross(corners[2] - corners[0]).norm());
    if (arrays.tangents.empty()) return at;
    const Vector3d t = unit_or(tangent, any_perpendicular(at.normal));
    at.axes << t, -at.normal.cross(t), at.normal;
    return at;
}

InputFrames::InputFrames(Primitive& primitive, const std::string& texcoord_set) {
    const MorphedColumn positions = primitive.attribute("POSITION", 3);
    const MorphedColumn texcoords = primitive.attribute(texcoord_set, 2);
    const std::vector<uint32_t> corners = primitive.corners();
    const size_t rows = positions.base.count;
    std::vector<Vector3d> normals(rows, Vector3d::Zero()), along_u(rows, Vector3d::Zero()), up(rows, Vector3d::Zero());
    for (size_t i = 0; i + 2 < corners.size(); i += 3) {
        const Vector3d a = row_of(positions, corners[i]);
        const Vector3d e = row_of(positions, corners[i + 1]) - a, f = row_of(positions, corners[i + 2]) - a;
        const auto uv = [&](size_t k) {
            return Vector2d(texcoords.at(corners[i + k], 0), texcoords.at(corners[i + k], 1));
        };
        const Vector2d p = uv(1) - uv(0), q = uv(2) - uv(0);
        const double sign = p.x() * q.y() - p.y() * q.x() < 0 ? -1 : 1;
        for (size_t k = 0; k < 3; ++k) {
            normals[corners[i + k]] += e.cross(f);
            along_u[corners[i + k]] += sign * (e * q.y() - f * p.y());
            up[corners[i + k]] -= sign * (f * p.x() - e * q.x());  // v points down
        }
    }
    const bool has_normals = primitive.has("NORMAL"), has_tangents = primitive.has("TANGENT") && has_normals;
    MorphedColumn own_normals, own_tangents;
    if (has_normals) own_normals = primitive.attribute("NORMAL", 3);
    if (has_tangents) own_tangents = primitive.attribute("TANGENT", 4);
    for (size_t row = 0; row < rows; ++row) {
        const Vector3d n = unit_or(has_normals ? row_of(own_normals, row) : normals[row], Vector3d::UnitZ());
        const Vector3d t = has_tangents ? row_of(own_tangents, row) : along_u[row];
        const Vector3d level = unit_or(t - n * n.dot(t), any_perpendicular(n));
        normals_.push_back(n);
        tangents_.push_back(level);
        signs_.push_back(has_tangents ? own_tangents.at(row, 3) : n.cross(level).dot(up[row]) < 0 ? -1.0 : 1.0);
    }
}

Matrix3d InputFrames::axes(const std::array<uint32_t, 3>& rows, const std::array<double, 3>& weights) const {
    Vector3d n = Vector3d::Zero(), t = Vector3d::Zero();
    for (size_t k = 0; k < 3; ++k) {
        n += weights[k] * normals_[rows[k]];
        t += weights[k] * tangents_[rows[k]];
    }
    n = unit_or(n, Vector3d::UnitZ());
    t = unit_or(t, any_perpendicular(n));
    Matrix3d axes;
    axes << t, n.cross(t) * signs_[rows[0]], n;
    return axes;
}

}  // namespace gim::gltf
