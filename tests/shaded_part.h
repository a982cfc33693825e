// A machined part with the normals that its author means, as tests need it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "gim/encoder.h"

namespace gim::test {

// A bar whose profile is an arc and two straight sides. The straight sides meet each other at 30 degrees, which the shape
// alone does not show as a crease, and the arc at 75 degrees. The arc bends by 11 degrees from facet to facet.
class ShadedPart {
  public:
    static constexpr uint32_t kArc = 16, kSide = 4, kAround = kArc + 2 * kSide, kRows = 6;
    static constexpr uint32_t kHardEdges = 2 * kAround + 3 * kRows;

    ShadedPart() {
        for (uint32_t row = 0; row <= kRows; ++row) {
            for (uint32_t k = 0; k < kAround; ++k) {
                const auto [x, y] = profile(k);
                mesh.positions.push_back({x, y, 2.0 * row / kRows - 1});
            }
        }
        for (uint32_t row = 0; row < kRows; ++row) {
            for (uint32_t k = 0; k < kAround; ++k) {
                const uint32_t a = row * kAround + k, b = row * kAround + (k + 1) % kAround;
                const auto from = normal(k, k), to = normal(k, k + 1);
                add({a, b, b + kAround}, {from, to, to});
                add({a, b + kAround, a + kAround}, {from, to, from});
            }
        }
        for (const bool is_top : {false, true}) {
            const auto middle = static_cast<uint32_t>(mesh.positions.size());
            mesh.positions.push_back({0, 0.2, is_top ? 1.0 : -1.0});
            const std::array<float, 3> n = {0, 0, is_top ? 1.0F : -1.0F};
            const uint32_t first = is_top ? kRows * kAround : 0;
            for (uint32_t k = 0; k < kAround; ++k) {
                const uint32_t a = first + k, b = first + (k + 1) % kAround;
                add(is_top ? std::array{middle, a, b} : std::array{middle, b, a}, {n, n, n});
            }
        }
    }

    // Vertices are shared, also on hard edges. Each corner has its own entry in the list of normals.
    TriangleMesh mesh;

    // The same with a vertex for each position and normal, as engines want it.
    TriangleMesh split() const {
        std::map<std::pair<uint32_t, std::array<float, 3>>, uint32_t> known;
        TriangleMesh result;
        for (size_t f = 0; f < mesh.triangles.size(); ++f) {
            std::array<uint32_t, 3> triangle = {};
            for (size_t i = 0; i < 3; ++i) {
                const uint32_t v = mesh.triangles[f][i];
                const auto& n = mesh.shading.normals[mesh.shading.corners[f][i]];
                const auto [at, is_new] = known.try_emplace({v, n}, static_cast<uint32_t>(known.size()));
                if (is_new) {
                    result.positions.push_back(mesh.positions[v]);
                    result.shading.normals.push_back(n);
                }
                triangle[i] = at->second;
            }
            result.triangles.push_back(triangle);
        }
        result.shading.corners = result.triangles;
        return result;
    }

  private:
    static std::array<double, 2> profile(uint32_t k) {
        if (k <= kArc) {
            const double angle = std::numbers::pi * k / kArc;
            return {std::cos(angle), std::sin(angle)};
        }
        const double x = static_cast<double>(k - kArc) / kSide - 1;
        return {x, -std::tan(std::numbers::pi / 12) * (1 - std::abs(x))};
    }

    // Of the surface beside profile point k, on the side of the profile's edge `edge`.
    static std::array<float, 3> normal(uint32_t edge, uint32_t k) {
        if (edge < kArc) {
            const double angle = std::numbers::pi * k / kArc;
            return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
        }
        const double angle = std::numbers::pi / 12, side = edge < kArc + kSide ? -1 : 1;
        return {static_cast<float>(side * std::sin(angle)), static_cast<float>(-std::cos(angle)), 0};
    }

    void add(const std::array<uint32_t, 3>& triangle, const std::array<std::array<float, 3>, 3>& normals) {
        const auto first = static_cast<uint32_t>(mesh.shading.normals.size());
        mesh.triangles.push_back(triangle);
        mesh.shading.normals.insert(mesh.shading.normals.end(), normals.begin(), normals.end());
        mesh.shading.corners.push_back({first, first + 1, first + 2});
    }
};

// Gives each triangle its own normal.
inline void shade_flat(TriangleMesh& mesh) {
    mesh.shading = {};
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        const auto at = [&](size_t i) { return mesh.positions[mesh.triangles[f][i]]; };
        const auto a = at(0), b = at(1), c = at(2);
        std::array<float, 3> n = {};
        for (size_t k = 0; k < 3; ++k) {
            const size_t u = (k + 1) % 3, v = (k + 2) % 3;
            n[k] = static_cast<float>((b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]));
        }
        mesh.shading.normals.push_back(n);
        mesh.shading.corners.push_back({f, f, f});
    }
}

}  // namespace gim::test
