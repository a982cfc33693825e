#include "encoder/charts/chart_newton.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/surface/stretch.h"

namespace gim {

namespace {

constexpr int kPatience = 20;  // steps before a hopeless energy counts

class Newton {
  public:
    Newton(const Mesh& mesh, const std::vector<MapElement>& elements, const BorderForce* force, std::vector<Vec2>& uv)
        : mesh_(mesh),
          elements_(elements),
          force_(force),
          uv_(uv),
          hessian_(2 * size(), 2 * size()),
          gradient_(2 * size()) {
        for (const Triangle& t : mesh_.triangles) {
            // The pattern only; values are filled in by slot.
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    for (int a = 0; a < 2; ++a)
                        for (int b = 0; b < 2; ++b) entries_.emplace_back(2 * t[i] + a, 2 * t[j] + b, 1.0);
        }
        for (Eigen::Index k = 0; k < 2 * size(); ++k) entries_.emplace_back(k, k, 1.0);
        hessian_.setFromTriplets(entries_.begin(), entries_.end());
        slots_.reserve(36 * mesh_.triangles.size());
        for (const auto& entry : entries_)
            slots_.push_back(&hessian_.coeffRef(entry.row(), entry.col()) - hessian_.valuePtr());
        entries_.clear();
        entries_.shrink_to_fit();
        solver_.analyzePattern(hessian_);
    }

    void run(const NewtonOptions& options) {
        double here = total(uv_);
        int small_gains = 0;
        for (int step = 0; step < options.most_steps && std::isfinite(here); ++step) {
            assemble();
            if (!solve()) break;
            const double slope = gradient_.dot(direction_);
            if (!(slope < 0)) break;
            const double reached = search(here, slope);
            const double gain = here - reached;
            here = reached;
            // A border in contact with itself sometimes holds back the whole step.
            small_gains = gain <= options.tolerance * here ? small_gains + 1 : 0;
            if (small_gains > (force_ ? 5 : 0) || (step >= kPatience && here > options.hopeless)) break;
        }
    }

  private:
    Eigen::Index size() const { return static_cast<Eigen::Index>(uv_.size()); }

    double total(const std::vector<Vec2>& uv) const {
        double sum = 0;
        for (size_t f = 0; f < elements_.size(); ++f) {
            const Triangle& t = mesh_.triangles[f];
            sum += energy(elements_[f], jacobian(elements_[f], uv[t[0]], uv[t[1]], uv[t[2]]));
            if (!std::isfinite(sum)) return sum;
        }
        return force_ ? sum + force_->energy(uv) : sum;
    }

    void assemble() {
        gradient_.setZero();
        double* values = hessian_.valuePtr();
        std::fill(values, values + hessian_.nonZeros(), 0.0);
        size_t slot = 0;
        Vector6 g;
        Matrix6 h;
        for (size_t f = 0; f < elements_.size(); ++f) {
            const Triangle& t = mesh_.triangles[f];
            derivatives(elements_[f], jacobian(elements_[f], uv_[t[0]], uv_[t[1]], uv_[t[2]]), g, h);
            for (int i = 0; i < 3; ++i) {
                gradient_[2 * t[i]] += g[2 * i];
                gradient_[2 * t[i] + 1] += g[2 * i + 1];
                for (int j = 0; j < 3; ++j)
                    for (int a = 0; a < 2; ++a)
                        for (int b = 0; b < 2; ++b) values[slots_[slot++]] += h(2 * i + a, 2 * j + b);
            }
        }
        const size_t diagonal = slot;
        if (force_) {
            force_->derivatives(uv_, [&](uint32_t v, const Vec2& gradient, const Eigen::Matrix2d& block) {
                for (int a = 0; a < 2; ++a) {
                    gradient_[2 * v + a] += gradient[a];
                    for (int b = 0; b < 2; ++b) hessian_.coeffRef(2 * v + a, 2 * v + b) += block(a, b);
                }
            });
        }
        // Rigid motions cost nothing, so a little of the identity is added to make the matrix definite.
        double trace = 0;
        for (size_t k = diagonal; k < slots_.size(); ++k) trace += values[slots_[k]];
        const double shift = 1e-7 * trace / static_cast<double>(slots_.size() - diagonal);
        for (size_t k = diagonal; k < slots_.size(); ++k) values[slots_[k]] += shift;
    }

    bool solve() {
        solver_.factorize(hessian_);
        if (solver_.info() != Eigen::Success) return false;
        direction_ = solver_.solve(-gradient_);
        return direction_.allFinite();
    }

    // Backtracks from the longest step that keeps all triangles upright. Returns the energy it reaches.
    double search(double here, double slope) {
        double step = 1;
        const auto direction = [&](uint32_t v) { return Vec2(direction_[2 * v], direction_[2 * v + 1]); };
        for (const Triangle& t : mesh_.triangles) {
            const Vec2 p = uv_[t[1]] - uv_[t[0]], q = uv_[t[2]] - uv_[t[0]];
            const Vec2 dp = direction(t[1]) - direction(t[0]), dq = direction(t[2]) - direction(t[0]);
            // area(s) = c + b s + a s^2 > 0
            const double c = cross(p, q), b = cross(dp, q) + cross(p, dq), a = cross(dp, dq);
            const double disc = b * b - 4 * a * c;
            if (disc < 0) continue;
            // Find the smaller positive root without cancellation.
            const double half = -0.5 * (b + std::copysign(std::sqrt(disc), b));
            for (const double root : {half / a, c / half}) {
                if (root > 0 && std::isfinite(root)) step = std::min(step, 0.9 * root);
            }
        }
        std::vector<Vec2> trial(uv_.size());
        for (int halving = 0; halving < 25; ++halving, step *= 0.5) {
            for (uint32_t v = 0; v < uv_.size(); ++v) trial[v] = uv_[v] + step * direction(v);
            const double reached = total(trial);
            if (reached <= here + 1e-4 * step * slope) {
                uv_.swap(trial);
                return reached;
            }
        }
        return here;
    }

    const Mesh& mesh_;
    const std::vector<MapElement>& elements_;
    const BorderForce* force_;
    std::vector<Vec2>& uv_;
    std::vector<Eigen::Triplet<double>> entries_;
    Eigen::SparseMatrix<double> hessian_;
    std::vector<std::ptrdiff_t> slots_;  // 36 per triangle, then the diagonal
    Eigen::VectorXd gradient_, direction_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace

void minimise_energy(const Mesh& mesh, const std::vector<MapElement>& elements, const BorderForce* force,
                     const NewtonOptions& options, std::vector<Vec2>& uv) {
    Newton(mesh, elements, force, uv).run(options);
}

}  // namespace gim
