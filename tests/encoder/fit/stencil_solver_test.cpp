#include "encoder/fit/stencil_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "encoder/base/parallel.h"
#include "encoder/surface/surface_samples.h"
#include "tests/encoder/grid_images.h"

namespace gim {
namespace {

double unit(uint64_t k) { return static_cast<double>(mix_bits(k) >> 11) * 0x1p-52 - 1; }

struct Problem {
    StencilMatrix matrix;
    Eigen::MatrixXd dense;  // of all samples, unglued
    std::vector<Vec3> right;
};

// Springs with random directional weights between all neighbours, and a soft anchor at every sample.
Problem random_problem(uint32_t width, uint32_t height) {
    const uint32_t n = width * height;
    Problem problem{StencilMatrix(width, height), Eigen::MatrixXd::Zero(3 * n, 3 * n), {}};
    uint64_t draw = 1;
    const auto add = [&](uint32_t i, uint32_t j, const Eigen::Matrix3d& w, double factor) {
        const SymmetricBlock block = {float(w(0, 0)), float(w(0, 1)), float(w(0, 2)),
                                      float(w(1, 1)), float(w(1, 2)), float(w(2, 2))};
        problem.matrix.add(i, j, block, static_cast<float>(factor));
        problem.dense.block<3, 3>(3 * i, 3 * j) += factor * w;
        if (i != j) problem.dense.block<3, 3>(3 * j, 3 * i) += factor * w;
    };
    const auto random_weight = [&] {
        const Vec3 a(unit(draw), unit(draw + 1), unit(draw + 2));
        draw += 3;
        return Eigen::Matrix3d(a * a.transpose() + 0.05 * Eigen::Matrix3d::Identity());
    };
    for (uint32_t row = 0; row < height; ++row) {
        for (uint32_t column = 0; column < width; ++column) {
            const uint32_t i = row * width + column;
            add(i, i, 0.1 * random_weight(), 1);
            const auto spring = [&](uint32_t j) {
                const Eigen::Matrix3d w = random_weight();
                add(i, i, w, 1);
                add(j, j, w, 1);
                add(i, j, w, -1);
            };
            if (column + 1 < width) spring(i + 1);
            if (row + 1 < height) spring(i + width);
            if (row + 1 < height && column + 1 < width) spring(i + width + 1);
            if (row + 1 < height && column > 0) spring(i + width - 1);
            problem.right.emplace_back(unit(draw), unit(draw + 1), unit(draw + 2));
            draw += 3;
        }
    }
    return problem;
}

// Solves the same by elimination, with the rows and columns of each class added up.
std::vector<Vec3> solve_densely(const Problem& problem, const GridGluing& gluing, const std::vector<bool>& fixed) {
    const auto n = static_cast<Eigen::Index>(problem.right.size());
    Eigen::MatrixXd glue = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    Eigen::VectorXd right(3 * n);
    for (Eigen::Index v = 0; v < n; ++v) {
        if (gluing.is_defined(static_cast<uint32_t>(v)))
            glue.block<3, 3>(3 * v, 3 * Eigen::Index{gluing.representative[v]}).setIdentity();
        right.segment<3>(3 * v) = problem.right[v];
    }
    Eigen::MatrixXd a = glue.transpose() * problem.dense * glue;
    Eigen::VectorXd b = glue.transpose() * right;
    for (Eigen::Index v = 0; v < n; ++v) {
        if (gluing.representative[v] == static_cast<uint32_t>(v) && !fixed[v]) continue;
        a.middleRows(3 * v, 3).setZero();
        a.middleCols(3 * v, 3).setZero();
        a.block<3, 3>(3 * v, 3 * v).setIdentity();
        b.segment<3>(3 * v).setZero();
    }
    const Eigen::VectorXd x = glue * a.ldlt().solve(b);
    std::vector<Vec3> values;
    for (Eigen::Index v = 0; v < n; ++v) values.emplace_back(x.segment<3>(3 * v));
    return values;
}

void expect_equal_to_elimination(const GridGluing& gluing, const std::vector<bool>& fixed) {
    const Problem problem = random_problem(gluing.width, gluing.height);
    const Solution solution =
        solve(problem.matrix, problem.right, gluing, fixed, {.most_steps = 2000, .tolerance = 1e-6});
    const std::vector<Vec3> expected = solve_densely(problem, gluing, fixed);
    for (size_t v = 0; v < expected.size(); ++v) EXPECT_NEAR((solution.values[v] - expected[v]).norm(), 0, 2e-4) << v;
}

TEST(StencilSolver, AgreesWithElimination) {
    expect_equal_to_elimination(glue_ring(open_sideband(), 9).value(), std::vector<bool>(81, false));
}

TEST(StencilSolver, GluedSamplesAreOneUnknown) {
    expect_equal_to_elimination(glue_ring(torus_image(9, 1, 0.3).sideband, 9).value(), std::vector<bool>(81, false));
}

TEST(StencilSolver, UndefinedSamplesStayAtZero) {
    const MultiChartImage image = sphere_charts(5);
    expect_equal_to_elimination(image.gluing, std::vector<bool>(55, false));
}

TEST(StencilSolver, FixedSamplesStayAtZero) {
    std::vector<bool> fixed(81, false);
    fixed[40] = fixed[41] = fixed[13] = true;
    expect_equal_to_elimination(glue_ring(open_sideband(), 9).value(), fixed);
}

TEST(StencilSolver, ThreadsChangeNothing) {
    const Problem problem = random_problem(33, 33);
    const GridGluing gluing = glue_ring(torus_image(33, 1, 0.3).sideband, 33).value();
    const std::vector<bool> fixed(33 * 33, false);
    std::vector<Vec3> one, two;
    with_threads(1, [&] { one = solve(problem.matrix, problem.right, gluing, fixed, {}).values; });
    with_threads(2, [&] { two = solve(problem.matrix, problem.right, gluing, fixed, {}).values; });
    EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace gim
