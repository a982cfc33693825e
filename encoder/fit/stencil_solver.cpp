// Conjugate gradients on the grid (stencil_solver.h).
// Cost: O(samples) a step; about a millisecond for 257 x 257 on one core.
#include "encoder/fit/stencil_solver.h"

#include <Eigen/LU>
#include <cmath>

#include "encoder/base/parallel.h"
#include "format/inline.h"

namespace gim {

namespace {

constexpr size_t kRowsPerBlock = 16;

Channels make_channels(size_t count) {
    Channels channels;
    for (auto& channel : channels) channel.assign(count, 0.0f);
    return channels;
}

class Solver {
  public:
    Solver(const StencilMatrix& matrix, const GridGluing& gluing, const std::vector<bool>& fixed)
        : matrix_(matrix),
          gluing_(gluing),
          width_(matrix.width()),
          height_(matrix.height()),
          count_(size_t{width_} * height_) {
        counted_.assign(count_, 1.0f);
        free_.assign(count_, 1.0f);
        for (const auto& members : gluing.shared) {
            for (size_t k = 1; k < members.size(); ++k) counted_[members[k]] = 0;
            bool any_fixed = false;
            for (const uint32_t v : members) any_fixed = any_fixed || fixed[v];
            for (const uint32_t v : members) free_[v] = any_fixed ? 0.0f : 1.0f;
        }
        for (size_t v = 0; v < count_; ++v) {
            if (fixed[v] || !gluing.is_defined(static_cast<uint32_t>(v))) free_[v] = 0;
        }
        build_preconditioner();
    }

    Solution run(const std::vector<Vec3>& right, const SolverOptions& options) {
        Channels x = make_channels(count_), residual = make_channels(count_), z = make_channels(count_);
        Channels direction = make_channels(count_), image = make_channels(count_);
        for (size_t v = 0; v < count_; ++v) {
            for (int k = 0; k < 3; ++k) residual[k][v] = static_cast<float>(right[v][k]);
        }
        sum_over_classes(residual);
        for (size_t v = 0; v < count_; ++v) {
            for (int k = 0; k < 3; ++k) residual[k][v] *= free_[v];
        }
        Dots dots = precondition(residual, z);
        const double goal = options.tolerance * options.tolerance * dots.residual2;
        direction = z;

        Solution solution;
        while (solution.steps < options.most_steps && dots.residual2 > goal) {
            apply(direction, image);
            const double curvature = dot(direction, image);
            if (!(curvature > 0)) break;
            const auto alpha = static_cast<float>(dots.residual_z / curvature);
            for_rows([&](size_t begin, size_t end) {
                for (int k = 0; k < 3; ++k) {
                    for (size_t v = begin; v < end; ++v) {
                        x[k][v] += alpha * direction[k][v];
                        residual[k][v] -= alpha * image[k][v];
                    }
                }
            });
            const Dots before = dots;
            dots = precondition(residual, z);
            const auto beta = static_cast<float>(dots.residual_z / before.residual_z);
            for_rows([&](size_t begin, size_t end) {
                for (int k = 0; k < 3; ++k) {
                    for (size_t v = begin; v < end; ++v) direction[k][v] = z[k][v] + beta * direction[k][v];
                }
            });
            ++solution.steps;
        }
        solution.values.resize(count_);
        for (size_t v = 0; v < count_; ++v) solution.values[v] = Vec3(x[0][v], x[1][v], x[2][v]);
        return solution;
    }

  private:
    struct Dots {
        double residual2 = 0, residual_z = 0;
    };

    // Runs body in parallel on blocks of whole rows, given as ranges of samples.
    template <class Body>
    void for_rows(const Body& body) const {
        parallel_blocks(height_, kRowsPerBlock, 0,
                        [&](size_t, size_t begin, size_t end) { body(begin * width_, end * width_); });
    }

    template <class Term>
    double sum_rows(const Term& term) const {
        std::vector<double> partial((height_ + kRowsPerBlock - 1) / kRowsPerBlock, 0.0);
        parallel_blocks(height_, kRowsPerBlock, 0, [&](size_t block, size_t begin, size_t end) {
            partial[block] = term(begin * width_, end * width_);
        });
        double total = 0;
        for (const double sum : partial) total += sum;
        return total;
    }

    double dot(const Channels& a, const Channels& b) const {
        return sum_rows([&](size_t begin, size_t end) {
            double sum = 0;
            for (size_t v = begin; v < end; ++v) {
                sum += double{counted_[v] * (a[0][v] * b[0][v] + a[1][v] * b[1][v] + a[2][v] * b[2][v])};
            }
            return sum;
        });
    }

    void sum_over_classes(Channels& values) const {
        for (const auto& members : gluing_.shared) {
            for (auto& channel : values) {
                float sum = 0;
                for (const uint32_t v : members) sum += channel[v];
                for (const uint32_t v : members) channel[v] = sum;
            }
        }
    }

    void build_preconditioner() {
        inverse_.assign(6, std::vector<float>(count_));
        Eigen::Matrix<float, 6, 1> sum;
        std::vector<std::array<float, 6>> blocks(count_);
        for (size_t v = 0; v < count_; ++v) {
            for (size_t k = 0; k < 6; ++k) blocks[v][k] = matrix_.channel(StencilMatrix::kDiagonal, k)[v];
        }
        for (const auto& members : gluing_.shared) {
            sum.setZero();
            for (const uint32_t v : members) {
                for (int k = 0; k < 6; ++k) sum[k] += blocks[v][k];
            }
            for (const uint32_t v : members) {
                for (int k = 0; k < 6; ++k) blocks[v][k] = sum[k];
            }
        }
        for_rows([&](size_t begin, size_t end) {
            for (size_t v = begin; v < end; ++v) {
                const auto& b = blocks[v];
                Eigen::Matrix3d full;
                full << b[0], b[1], b[2], b[1], b[3], b[4], b[2], b[4], b[5];
                Eigen::Matrix3d inverse = full.inverse();
                if (!inverse.allFinite() || free_[v] == 0) inverse.setZero();
                const std::array<double, 6> entries = {inverse(0, 0), inverse(0, 1), inverse(0, 2),
                                                       inverse(1, 1), inverse(1, 2), inverse(2, 2)};
                for (size_t k = 0; k < 6; ++k) inverse_[k][v] = static_cast<float>(entries[k]);
            }
        });
    }

    // Computes z = M^-1 r, and returns the two products that the next step needs.
    Dots precondition(const Channels& r, Channels& z) const {
        std::vector<Dots> partial((height_ + kRowsPerBlock - 1) / kRowsPerBlock);
        parallel_blocks(height_, kRowsPerBlock, 0, [&](size_t block, size_t first, size_t last) {
            const size_t begin = first * width_, end = last * width_;
            const float *xx = inverse_[0].data(), *xy = inverse_[1].data(), *xz = inverse_[2].data();
            const float *yy = inverse_[3].data(), *yz = inverse_[4].data(), *zz = inverse_[5].data();
            for (size_t v = begin; v < end; ++v) {
                z[0][v] = xx[v] * r[0][v] + xy[v] * r[1][v] + xz[v] * r[2][v];
                z[1][v] = xy[v] * r[0][v] + yy[v] * r[1][v] + yz[v] * r[2][v];
                z[2][v] = xz[v] * r[0][v] + yz[v] * r[1][v] + zz[v] * r[2][v];
            }
            Dots sum;
            for (size_t v = begin; v < end; ++v) {
                sum.residual_z += double{counted_[v] * (r[0][v] * z[0][v] + r[1][v] * z[1][v] + r[2][v] * z[2][v])};
                sum.residual2 += double{counted_[v] * (r[0][v] * r[0][v] + r[1][v] * r[1][v] + r[2][v] * r[2][v])};
            }
            partial[block] = sum;
        });
        Dots total;
        for (const Dots& p : partial) {
            total.residual2 += p.residual2;
            total.residual_z += p.residual_z;
        }
        return total;
    }

    void apply(const Channels& in, Channels& out) const {
        matrix_.multiply(in, out);
        sum_over_classes(out);
        for_rows([&](size_t begin, size_t end) {
            for (auto& channel : out) {
                for (size_t v = begin; v < end; ++v) channel[v] *= free_[v];
            }
        });
    }

    const StencilMatrix& matrix_;
    const GridGluing& gluing_;
    uint32_t width_, height_;
    size_t count_;
    std::vector<float> counted_;  // 1 for one sample of each class
    std::vector<float> free_;     // 0 for fixed samples
    std::vector<std::vector<float>> inverse_;
};

// Adds the products of n symmetric blocks (xx, xy, xz, yy, yz, zz) with the triples in x, y, z.
GIM_VECTOR_CLONES void add_products(ptrdiff_t n, const float* xx, const float* xy, const float* xz, const float* yy,
                                    const float* yz, const float* zz, const float* x, const float* y, const float* z,
                                    float* __restrict ox, float* __restrict oy, float* __restrict oz) {
    for (ptrdiff_t i = 0; i < n; ++i) {
        ox[i] += xx[i] * x[i] + xy[i] * y[i] + xz[i] * z[i];
        oy[i] += xy[i] * x[i] + yy[i] * y[i] + yz[i] * z[i];
        oz[i] += xz[i] * x[i] + yz[i] * y[i] + zz[i] * z[i];
    }
}

}  // namespace

// Adds to out[begin..end) the product block[begin - block_shift ..) * in[begin + shift ..).
void StencilMatrix::accumulate(Kind kind, size_t begin, size_t end, ptrdiff_t block_shift, ptrdiff_t shift,
                               const Channels& in, Channels& out) const {
    const auto n = static_cast<ptrdiff_t>(end - begin);
    const auto base = static_cast<ptrdiff_t>(begin);
    const float* b[6];
    for (size_t k = 0; k < 6; ++k) b[k] = channel(kind, k) + base + block_shift;
    const float *x = in[0].data() + base + shift, *y = in[1].data() + base + shift, *z = in[2].data() + base + shift;
    add_products(n, b[0], b[1], b[2], b[3], b[4], b[5], x, y, z, out[0].data() + base, out[1].data() + base,
                 out[2].data() + base);
}

// The first of two samples stores the block between them. Each row gathers from itself and its two neighbours.
void StencilMatrix::multiply(const Channels& in, Channels& out) const {
    const auto width = static_cast<ptrdiff_t>(width_);
    parallel_blocks(height_, kRowsPerBlock, 0, [&](size_t, size_t first, size_t last) {
        for (size_t row = first; row < last; ++row) {
            const size_t begin = row * width_, end = begin + width_;
            for (auto& channel : out)
                std::fill(channel.begin() + static_cast<ptrdiff_t>(begin),
                          channel.begin() + static_cast<ptrdiff_t>(end), 0.0f);
            accumulate(kDiagonal, begin, end, 0, 0, in, out);
            accumulate(kEast, begin, end - 1, 0, 1, in, out);
            accumulate(kEast, begin + 1, end, -1, -1, in, out);
            if (row + 1 < height_) {
                accumulate(kSouth, begin, end, 0, width, in, out);
                accumulate(kSouthEast, begin, end - 1, 0, width + 1, in, out);
                accumulate(kSouthWest, begin + 1, end, 0, width - 1, in, out);
            }
            if (row > 0) {
                accumulate(kSouth, begin, end, -width, -width, in, out);
                accumulate(kSouthEast, begin + 1, end, -width - 1, -width - 1, in, out);
                accumulate(kSouthWest, begin, end - 1, -width + 1, -width + 1, in, out);
            }
        }
    });
}

Solution solve(const StencilMatrix& matrix, const std::vector<Vec3>& right, const GridGluing& gluing,
               const std::vector<bool>& fixed, const SolverOptions& options) {
    return Solver(matrix, gluing, fixed).run(right, options);
}

}  // namespace gim
