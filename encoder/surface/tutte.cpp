#include "encoder/surface/tutte.h"

#include <Eigen/SparseCholesky>

namespace gim {

bool solve_tutte(const std::vector<std::array<uint32_t, 2>>& arcs, const std::vector<uint8_t>& fixed,
                 std::vector<Vec2>& uv) {
    std::vector<uint32_t> number(uv.size(), kNone), free;
    for (uint32_t v = 0; v < uv.size(); ++v) {
        if (!fixed[v]) number[v] = static_cast<uint32_t>(free.size()), free.push_back(v);
    }
    if (free.empty()) return true;
    const auto n = static_cast<Eigen::Index>(free.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
    for (const auto& [v, w] : arcs) {
        const uint32_t row = number[v];
        if (row == kNone) continue;
        entries.emplace_back(row, row, 1.0);
        if (number[w] == kNone) {
            right.row(row) += uv[w].transpose();
        } else {
            entries.emplace_back(row, number[w], -1.0);
        }
    }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
    if (solver.info() != Eigen::Success) return false;
    const Eigen::MatrixX2d solution = solver.solve(right);
    for (Eigen::Index i = 0; i < n; ++i) uv[free[static_cast<size_t>(i)]] = solution.row(i).transpose();
    return true;
}

}  // namespace gim
