// The end of a round: moves samples as far as they fold no cell.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/fit/fitter.h"
#include "encoder/fit/image_surface.h"

namespace gim {

namespace {

constexpr double kSteepest = 0.1;  // cosine below which the guard acts
constexpr int kMostHalvings = 8;
constexpr int kMostFreezings = 16;  // further passes of the guard, which drop steps instead of halving them

}  // namespace

Vec3 Fitter::moved(uint32_t v, const Vec3& step) const {
    if (rails_.holds(v) && !fixed_[v]) return rails_.nearest(v, x_[v] + step);
    if (!gluing_.on_input_boundary[v] || fixed_[v]) return x_[v] + step;
    return reference_.curve_tree.find(x_[v] + step).point;
}

void Fitter::take_step(const std::vector<Vec3>& step, bool guarded) {
    std::vector<double> factor(x_.size(), 1.0);
    for (size_t v = 0; v < x_.size(); ++v) {
        const double limit = 0.5 * std::sqrt(vertex_area_[v]), length = step[v].norm();
        if (length > limit) factor[v] = limit / length;
    }
    std::vector<Vec3> target(x_.size());
    std::vector<uint32_t> moving(x_.size()), cells;
    std::iota(moving.begin(), moving.end(), 0u);
    for (uint32_t cell = 0; cell < gluing_.kind.size(); ++cell) {
        if (gluing_.kind[cell] != CellKind::kEmpty) cells.push_back(cell);
    }
    for (int halving = 0; halving < kMostHalvings + kMostFreezings; ++halving) {
        parallel_blocks(moving.size(), 4096, 0, [&](size_t, size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k) {
                const uint32_t v = moving[k];
                target[v] = factor[v] == 0 ? x_[v] : moved(v, factor[v] * step[v]);
            }
        });
        if (!guarded) break;
        const std::vector<uint32_t> bad = cells_that_turn_away(target, cells);
        if (bad.empty()) break;
        moving.clear();
        std::vector<bool> shortened(x_.size(), false);
        for (const uint32_t cell : bad) {
            for (const uint32_t corner : gluing_.corners(cell)) {
                const auto shorten = [&](uint32_t v) {
                    if (shortened[v]) return;
                    shortened[v] = true;
                    factor[v] = halving < kMostHalvings ? 0.5 * factor[v] : 0;
                    moving.push_back(v);
                };
                if (gluing_.class_of[corner] == kNone) {
                    shorten(corner);
                } else {
                    for (const uint32_t v : gluing_.shared[gluing_.class_of[corner]]) shorten(v);
                }
            }
        }
        cells = cells_around(moving);
    }
    x_ = std::move(target);
    for (size_t f = 0; f < face_hint_.size(); ++f) face_hint_[f] = nearest_reference_face_[f];
}

std::vector<uint32_t> Fitter::cells_around(const std::vector<uint32_t>& samples) const {
    std::vector<uint32_t> cells;
    for (const uint32_t v : samples) for_each_cell_at(gluing_, v, [&](uint32_t cell) { cells.push_back(cell); });
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

std::vector<uint32_t> Fitter::cells_that_turn_away(const std::vector<Vec3>& target,
                                                   const std::vector<uint32_t>& cells) const {
    std::vector<uint8_t> bad(cells.size());
    parallel_blocks(cells.size(), 2048, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const uint32_t cell = cells[k];
            const std::array<Triangle, 2> now = split_cell(x_, gluing_, cell);
            const auto is_held = [&](const Triangle& t) { return t != kNoFace && touches(t, held_); };
            if (is_held(now[0]) || is_held(now[1])) continue;
            const double then = facing(target, split_cell(target, gluing_, cell), cell);
            bad[k] = then < kSteepest && then < facing(x_, now, cell) ? 1 : 0;
        }
    });
    std::vector<uint32_t> result;
    for (size_t k = 0; k < cells.size(); ++k) {
        if (bad[k]) result.push_back(cells[k]);
    }
    return result;
}

double Fitter::facing(const std::vector<Vec3>& positions, const std::array<Triangle, 2>& faces, uint32_t cell) const {
    double least = 1;
    for (size_t half = 0; half < 2; ++half) {
        const Triangle& t = faces[half];
        if (t == kNoFace) continue;
        const Vec3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
        const Vec3 normal = front_ * direction_or((b - a).cross(c - a), Vec3::Zero());
        const uint32_t known = nearest_reference_face_[2 * size_t{cell} + half];
        double cosine = known == kNone ? -1 : normal.dot(reference_.normals[known]);
        if (cosine < kUnsuspicious) {
            cosine = normal.dot(reference_.normals[reference_.tree.find((a + b + c) / 3, known).triangle]);
        }
        least = std::min(least, cosine);
    }
    return least;
}

}  // namespace gim
