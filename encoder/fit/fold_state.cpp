#include "encoder/fit/fold_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/fit/image_surface.h"

namespace gim {

namespace {

// Cosine below which a face counts as folded. At creases a good face may stand across the nearest one.
constexpr double kSteep = 0.03;
constexpr double kUnsuspicious = 0.7;  // cosine above which a stale reference face is good enough
constexpr double kLeastRefold = 1;     // bits
constexpr double kStill = 1e-8;        // squared shift, in squared steps, of a sample that does not move

}  // namespace

FoldState::FoldState(const ShownSurface& shown, CodedImage& image, const RepairEffort& effort,
                     std::vector<uint32_t>& nearest)
    : shown_(shown),
      image_(image),
      effort_(effort),
      nearest_(nearest),
      unit_(double{image.units().step} * shown.frame.scale),
      quantizer_(double{image.units().quantizer}),
      prices_(image.bands()),
      levels_(image.decode()),
      x_(positions(levels_)),
      x_before_(x_),
      margin_(shown.gluing.kind.size(), 0),
      cost_(shown.gluing.kind.size(), 0) {
    find_steep_cells();
}

std::vector<Vec3> FoldState::positions(const CodedImage::Levels& levels) const {
    return positions_of(image_.samples(levels), image_.units(), shown_.frame);
}

Vec3 FoldState::normal_of(const std::vector<Vec3>& x, const Triangle& t) const {
    const Vec3& a = x[t[0]];
    return shown_.front * direction_or((x[t[1]] - a).cross(x[t[2]] - a), Vec3::Zero());
}

double FoldState::cosine(const std::vector<Vec3>& x, const Triangle& t, uint32_t& near) const {
    const FitReference& reference = shown_.reference;
    const Vec3 normal = normal_of(x, t);
    if (near != kNone) {
        const double stale = normal.dot(reference.normals[near]);
        if (stale > kUnsuspicious) return stale;
    }
    near = reference.tree.find((x[t[0]] + x[t[1]] + x[t[2]]) / 3, near).triangle;
    return normal.dot(reference.normals[near]);
}

void FoldState::find_steep_cells() {
    std::vector<uint8_t> is_steep(cost_.size());
    parallel_blocks(is_steep.size(), 1024, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const auto cell = static_cast<uint32_t>(i);
            const auto faces = split_cell(x_, gluing(), cell);
            double least = 1;
            for (size_t half = 0; half < 2; ++half) {
                if (faces[half] == kNoFace) continue;
                const double c = cosine(x_, faces[half], nearest_[2 * i + half]);
                least = std::min(least, c);
                if (c < kSteep) is_steep[i] = 1;
            }
            margin_[i] = margin_of(faces, least);
            if (margin_[i] == 0) cost_[i] = cost_at(x_, cell);
        }
    });
    for (uint32_t cell = 0; cell < is_steep.size(); ++cell) {
        if (is_steep[cell]) steep_.push_back(cell);
    }
}

double FoldState::margin_of(const std::array<Triangle, 2>& faces, double least_cosine) const {
    if (least_cosine < kUnsuspicious) return 0;
    double margin = std::numeric_limits<double>::infinity();
    for (const Triangle& t : faces) {
        if (t == kNoFace) continue;
        const Vec3 a = x_[t[1]] - x_[t[0]], b = x_[t[2]] - x_[t[0]];
        const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
        if (longest > 0) margin = std::min(margin, a.cross(b).norm() / std::sqrt(longest));
    }
    return margin;
}

double FoldState::cost_at(const std::vector<Vec3>& x, uint32_t cell) const {
    return cost_with(x, cell, nearest_of(cell));
}

double FoldState::cost_with(const std::vector<Vec3>& x, uint32_t cell, const std::array<uint32_t, 2>& near) const {
    const auto faces = split_cell(x, gluing(), cell);
    double cost = 0;
    for (size_t half = 0; half < 2; ++half) {
        if (faces[half] == kNoFace) continue;
        const uint32_t face = near[half] != kNone ? near[half] : near[1 - half];
        if (face == kNone) continue;
        const Vec3& a = x[faces[half][0]];
        const Vec3 across = (x[faces[half][1]] - a).cross(x[faces[half][2]] - a);
        const double along = shown_.front * across.dot(shown_.reference.normals[face]), square = across.squaredNorm();
        if (along > 0 && along * along > kSteep * kSteep * square) continue;  // most faces; without a root
        const double c = square > 0 ? along / std::sqrt(square) : 0;
        if (c < kSteep) cost += effort_.fold + effort_.turn * (kSteep - c);
    }
    return cost;
}

uint32_t FoldState::face_near(uint32_t v) const {
    uint32_t face = kNone;
    for_each_cell_at(gluing(), v, [&](uint32_t cell) {
        for (const uint32_t near : nearest_of(cell)) {
            if (face == kNone) face = near;
        }
    });
    return face;
}

std::vector<uint32_t> FoldState::cells_at(std::span<const uint32_t> samples) const {
    std::vector<uint32_t> cells;
    std::vector<bool> is_known(cost_.size(), false);
    for (const uint32_t v : samples) {
        for_each_cell_at(gluing(), v, [&](uint32_t cell) {
            if (is_known[cell] || gluing().kind[cell] == CellKind::kEmpty) return;
            is_known[cell] = true;
            cells.push_back(cell);
        });
    }
    return cells;
}

std::vector<uint32_t> FoldState::move(const WeightedSamples& samples, const Vec3& shift) {
    const size_t before = moved_.size();
    for (const auto& [v, weight] : samples) {
        x_[v] += double{weight} * shift;
        moved_.push_back(v);
    }
    std::vector<uint32_t> cells = cells_at(std::span(moved_).subspan(before));
    for (const uint32_t cell : cells) cost_[cell] = cost_at(x_, cell);
    return cells;
}

FoldState::Move FoldState::move_to(CodedImage::Levels levels) const {
    Move move;
    move.x = positions(levels);
    move.levels = std::move(levels);
    for (uint32_t v = 0; v < x_.size(); ++v) {
        if (gluing().is_defined(v) && (move.x[v] - x_[v]).squaredNorm() > kStill * step() * step())
            move.samples.push_back(v);
    }
    move.cells = cells_at(move.samples);
    for (const uint32_t cell : move.cells) {
        std::array<uint32_t, 2> near = nearest_of(cell);
        const auto faces = split_cell(move.x, gluing(), cell);
        for (size_t half = 0; half < 2; ++half) {
            if (faces[half] != kNoFace) cosine(move.x, faces[half], near[half]);
        }
        move.nearest.push_back(near);
        const double more = cost_with(move.x, cell, near) - cost_[cell];
        move.fold_cost += more;
        if (std::abs(more) > kLeastRefold) move.refolded.push_back(cell);
    }
    return move;
}

void FoldState::take(Move move) {
    levels_ = std::move(move.levels);
    x_ = std::move(move.x);
    moved_.insert(moved_.end(), move.samples.begin(), move.samples.end());
    for (size_t k = 0; k < move.cells.size(); ++k) {
        const uint32_t cell = move.cells[k];
        for (size_t half = 0; half < 2; ++half) nearest_[2 * cell + half] = move.nearest[k][half];
        cost_[cell] = cost_at(x_, cell);
    }
}

}  // namespace gim
