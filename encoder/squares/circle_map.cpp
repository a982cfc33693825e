#include "encoder/squares/circle_map.h"

#include <Eigen/Geometry>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace gim {

namespace {

void place_boundary(const OpenedMesh& opened, std::vector<Vec2>& uv) {
    const size_t n = opened.loop.size();
    std::vector<double> along(n + 1, 0.0);
    for (size_t i = 0; i < n; ++i) {
        const Vec3& a = opened.mesh.positions[opened.loop[i]];
        const Vec3& b = opened.mesh.positions[opened.loop[(i + 1) % n]];
        along[i + 1] = along[i] + (b - a).norm();
    }
    // A little uniform spacing keeps coincident neighbours apart.
    constexpr double kUniform = 1e-6;
    for (size_t i = 0; i < n; ++i) {
        const double uniform = double(i) / double(n);
        const double part = along[n] > 0 ? (1 - kUniform) * along[i] / along[n] + kUniform * uniform : uniform;
        uv[opened.loop[i]] = {std::cos(2 * std::numbers::pi * part), std::sin(2 * std::numbers::pi * part)};
    }
}

// Returns tan(angle / 2) at corner a of the triangle a b c. It is bounded, so that slivers leave the system solvable.
double half_tangent(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = b - a, v = c - a;
    const double lengths = u.norm() * v.norm();
    if (lengths == 0) return 1;
    const double sine = u.cross(v).norm() / lengths, cosine = u.dot(v) / lengths;
    return std::clamp(sine / std::max(1 + cosine, 1e-9), 1e-3, 1e3);
}

}  // namespace

std::vector<Vec2> circle_map(const OpenedMesh& opened) {
    const Mesh& mesh = opened.mesh;
    std::vector<Vec2> uv(mesh.positions.size(), Vec2::Zero());
    place_boundary(opened, uv);
    std::vector<uint8_t> fixed(uv.size(), 0);
    for (const uint32_t v : opened.loop) fixed[v] = 1;
    std::vector<uint32_t> number(uv.size(), kNone), interior;
    for (uint32_t v = 0; v < uv.size(); ++v) {
        if (fixed[v]) continue;
        number[v] = static_cast<uint32_t>(interior.size());
        interior.push_back(v);
    }
    if (interior.empty()) return uv;

    const auto n = static_cast<Eigen::Index>(interior.size());
    double scale = 0;
    for (const Triangle& t : mesh.triangles) scale += (mesh.positions[t[1]] - mesh.positions[t[0]]).norm();
    scale /= static_cast<double>(mesh.triangles.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n);
    const auto add = [&](uint32_t v, uint32_t w, double tangent) {
        if (number[v] == kNone) return;
        const double weight = tangent / std::max((mesh.positions[w] - mesh.positions[v]).norm() / scale, 1e-3);
        diagonal[number[v]] += weight;
        if (number[w] == kNone) {
            right.row(number[v]) += weight * uv[w].transpose();
        } else {
            entries.emplace_back(number[v], number[w], -weight);
        }
    };
    for (const Triangle& t : mesh.triangles) {
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t v = t[i], a = t[(i + 1) % 3], b = t[(i + 2) % 3];
            const double tangent = half_tangent(mesh.positions[v], mesh.positions[a], mesh.positions[b]);
            add(v, a, tangent);
            add(v, b, tangent);
        }
    }
    for (Eigen::Index i = 0; i < n; ++i) entries.emplace_back(i, i, diagonal[i]);
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseLU<Eigen::SparseMatrix<double>> solver;
    solver.compute(matrix);
    if (solver.info() != Eigen::Success) return {};
    const Eigen::MatrixX2d solution = solver.solve(right);
    for (Eigen::Index i = 0; i < n; ++i) uv[interior[static_cast<size_t>(i)]] = solution.row(i).transpose();
    return uv;
}

}  // namespace gim
