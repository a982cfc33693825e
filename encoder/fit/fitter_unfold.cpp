// Finds cells that look away from the reference, and unfolds them. Runs at the beginning of a round.
#include <algorithm>
#include <cmath>

#include "encoder/base/parallel.h"
#include "encoder/fit/fitter.h"
#include "encoder/fit/image_surface.h"

namespace gim {

namespace {

constexpr double kUnfolded = 0.2;      // cosine from which a cell counts as unfolded
constexpr int kUnfoldPasses = 4;       // in each round that unfolds
constexpr double kUnfoldReach = 0.25;  // in mean sample spacings, in each of these rounds

}  // namespace

void Fitter::unfold(double most) {
    const std::vector<Vec3> origin = x_;
    for (int pass = 0; pass < kUnfoldPasses; ++pass) {
        const ImageSurface image(x_, gluing_);
        const std::vector<uint32_t> steep = steep_cells(image);
        if (steep.empty()) break;
        relax(samples_around(steep), origin, std::min(most, kUnfoldReach * std::sqrt(image.area() / samples_)));
    }
}

std::vector<uint32_t> Fitter::steep_cells(const ImageSurface& image) {
    std::vector<uint8_t> is_steep(image.normals.size());
    parallel_blocks(is_steep.size(), 2048, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) {
            const Triangle& t = image.mesh.triangles[f];
            if (touches(t, held_)) continue;
            uint32_t& hint = face_hint_[image.slot[f]];
            const auto cosine = [&] { return front_ * image.normals[f].dot(reference_.normals[hint]); };
            if (hint != kNone && cosine() > kUnsuspicious) continue;
            hint = reference_.tree.find((x_[t[0]] + x_[t[1]] + x_[t[2]]) / 3, hint).triangle;
            if (cosine() < kUnfolded) is_steep[f] = 1;
        }
    });
    std::vector<uint32_t> steep;
    for (size_t f = 0; f < is_steep.size(); ++f) {
        const uint32_t cell = image.slot[f] / 2;
        if (is_steep[f] && (steep.empty() || steep.back() != cell)) steep.push_back(cell);
    }
    return steep;
}

std::vector<uint32_t> Fitter::samples_around(const std::vector<uint32_t>& cells) const {
    const uint32_t width = gluing_.width;
    std::vector<bool> inside(x_.size(), false);
    for (const uint32_t cell : cells) {
        const uint32_t row = cell / (width - 1), column = cell % (width - 1);
        for (uint32_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 2, gluing_.height - 1); ++r) {
            for (uint32_t c = column > 0 ? column - 1 : 0; c <= std::min(column + 2, width - 1); ++c) {
                if (gluing_.is_defined(r * width + c)) inside[gluing_.representative[r * width + c]] = true;
            }
        }
    }
    std::vector<uint32_t> samples;
    for (uint32_t v = 0; v < inside.size(); ++v) {
        if (inside[v] && !fixed_[v] && !gluing_.on_input_boundary[v] && !rails_.holds(v)) samples.push_back(v);
    }
    return samples;
}

std::span<const uint32_t> Fitter::class_around(const uint32_t& v) const {
    if (gluing_.class_of[v] == kNone) return {&v, 1};
    return gluing_.shared[gluing_.class_of[v]];
}

void Fitter::relax(const std::vector<uint32_t>& samples, const std::vector<Vec3>& origin, double reach) {
    std::vector<Vec3> target(samples.size());
    parallel_blocks(samples.size(), 512, 0, [&](size_t, size_t begin, size_t end) {
        uint32_t hint = kNone;
        for (size_t k = begin; k < end; ++k) {
            const uint32_t v = samples[k];
            Vec3 sum = Vec3::Zero();
            double count = 0;
            const auto add = [&](uint32_t w) {
                sum += x_[w] - x_[v];
                count += 1;
            };
            for (const uint32_t u : class_around(v)) {
                if (gluing_.edges[u] & GridGluing::kNorth) add(u - gluing_.width);
                if (gluing_.edges[u] & GridGluing::kSouth) add(u + gluing_.width);
                if (gluing_.edges[u] & GridGluing::kWest) add(u - 1);
                if (gluing_.edges[u] & GridGluing::kEast) add(u + 1);
            }
            hint = reference_.tree.find(x_[v], hint).triangle;
            const Vec3& normal = reference_.normals[hint];
            Vec3 travel = x_[v] + 0.5 / count * (sum - sum.dot(normal) * normal) - origin[v];
            if (travel.norm() > reach) travel *= reach / travel.norm();
            target[k] = reference_.tree.find(origin[v] + travel, hint).point;
        }
    });
    for (size_t k = 0; k < samples.size(); ++k) {
        for (const uint32_t u : class_around(samples[k])) x_[u] = target[k];
    }
}

}  // namespace gim
