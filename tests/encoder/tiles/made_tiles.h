// Complexes of tiles made by hand, and images on them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/tile_image.h"

namespace gim::test {

struct MadeQuads {
    std::string name;
    std::vector<Quad> quads;
    std::vector<Vec3> corners;
    int euler = 2, boundary_loops = 0, components = 1;
};

inline MadeQuads cube() {
    MadeQuads m{"cube", {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}, {}};
    for (uint32_t v = 0; v < 8; ++v) m.corners.emplace_back(v & 1 ? 1 : -1, v & 2 ? 1 : -1, v & 4 ? 1 : -1);
    return m;
}

// columns, rows: at least 3.
inline MadeQuads torus(uint32_t columns, uint32_t rows) {
    MadeQuads m{"torus", {}, {}, 0};
    for (uint32_t r = 0; r < rows; ++r) {
        for (uint32_t c = 0; c < columns; ++c) {
            const auto at = [&](uint32_t row, uint32_t column) { return row % rows * columns + column % columns; };
            m.quads.push_back({at(r, c), at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)});
            const double u = 2 * M_PI * c / columns, v = 2 * M_PI * r / rows;
            m.corners.emplace_back((3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v));
        }
    }
    return m;
}

inline MadeQuads strip(uint32_t columns, uint32_t rows) {
    MadeQuads m{"strip", {}, {}, 1, 1};
    for (uint32_t r = 0; r <= rows; ++r)
        for (uint32_t c = 0; c <= columns; ++c) m.corners.emplace_back(c, r, 0.1 * c * r);
    for (uint32_t r = 0; r < rows; ++r) {
        for (uint32_t c = 0; c < columns; ++c) {
            const uint32_t a = r * (columns + 1) + c;
            m.quads.push_back({a, a + 1, a + columns + 2, a + columns + 1});
        }
    }
    return m;
}

// The surface of the cells of a grid of cubes: `solid` says which are there. Cells must touch in faces only.
inline MadeQuads cubes(const std::string& name, uint32_t columns, uint32_t rows, const std::string& solid, int euler) {
    MadeQuads m{name, {}, {}, euler};
    std::map<std::array<int, 3>, uint32_t> numbers;
    const auto vertex = [&](int x, int y, int z) {
        const auto [at, is_new] = numbers.try_emplace({x, y, z}, static_cast<uint32_t>(m.corners.size()));
        if (is_new) m.corners.emplace_back(x, y, z);
        return at->second;
    };
    const auto is_solid = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < int(columns) && y < int(rows) && solid[size_t(y) * columns + size_t(x)] == '#';
    };
    for (int y = 0; y < int(rows); ++y) {
        for (int x = 0; x < int(columns); ++x) {
            if (!is_solid(x, y)) continue;
            const auto p = [&](int a, int b, int c) { return vertex(x + a, y + b, c); };
            m.quads.push_back({p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0)});
            m.quads.push_back({p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)});
            if (!is_solid(x, y - 1)) m.quads.push_back({p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)});
            if (!is_solid(x, y + 1)) m.quads.push_back({p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0)});
            if (!is_solid(x - 1, y)) m.quads.push_back({p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)});
            if (!is_solid(x + 1, y)) m.quads.push_back({p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)});
        }
    }
    return m;
}

inline MadeQuads genus_2() { return cubes("genus-2", 5, 3, "######.#.######", -2); }

inline MadeQuads both(MadeQuads a, const MadeQuads& b) {
    const auto first = static_cast<uint32_t>(a.corners.size());
    for (Quad q : b.quads) {
        for (uint32_t& v : q) v += first;
        a.quads.push_back(q);
    }
    for (const Vec3& p : b.corners) a.corners.emplace_back(p + Vec3(9, 0, 0));
    a.name += "-and-" + b.name;
    a.euler += b.euler;
    a.boundary_loops += b.boundary_loops;
    a.components += b.components;
    return a;
}

// Two tiles glued all round: four vertices of valence 2.
inline MadeQuads pillow() {
    return {"pillow", {{0, 1, 2, 3}, {3, 2, 1, 0}}, {Vec3(0, 0, 0), Vec3(1, 0, 0.1), Vec3(1, 1, 0), Vec3(0, 1, 0.1)}};
}

inline std::vector<MadeQuads> all_made_quads() {
    return {cube(), torus(3, 3), torus(6, 4), strip(1, 1), strip(4, 2), genus_2(), pillow(), both(cube(), strip(2, 2))};
}

// Calls f(tile, row, column, sample) for all samples of all tiles.
template <class F>
void for_each_tile_sample(const MadeQuads& made, uint32_t exponent, const F& f) {
    const auto complex = complex_of(made.quads, static_cast<uint32_t>(made.corners.size()));
    const uint32_t side = 1u << exponent;
    const TileSamples samples(complex.value().view(), side);
    for (uint32_t t = 0; t < made.quads.size(); ++t)
        for (uint32_t r = 0; r <= side; ++r)
            for (uint32_t c = 0; c <= side; ++c) f(t, r, c, samples.at(t, r, c));
}

// Samples bilinear between the corners.
inline TileImage bilinear_tiles(const MadeQuads& made, uint32_t exponent) {
    TileImage image;
    image.quads = made.quads;
    image.vertices = static_cast<uint32_t>(made.corners.size());
    image.exponent = exponent;
    const double side = 1u << exponent;
    for_each_tile_sample(made, exponent, [&](uint32_t t, uint32_t r, uint32_t c, uint32_t sample) {
        const Quad& q = image.quads[t];
        const double u = c / side, v = r / side;
        if (sample >= image.positions.size()) image.positions.resize(sample + 1);
        image.positions[sample] = (1 - v) * ((1 - u) * made.corners[q[0]] + u * made.corners[q[1]]) +
                                  v * ((1 - u) * made.corners[q[3]] + u * made.corners[q[2]]);
    });
    return image;
}

// The same on a sphere if asked for, plus a wave, plus noise.
inline TileImage tile_image(const MadeQuads& made, uint32_t exponent, double noise = 0, bool on_sphere = false) {
    TileImage image = bilinear_tiles(made, exponent);
    for (Vec3& p : image.positions) {
        if (on_sphere) p.normalize();
        const double x = p[0], y = p[1], z = p[2];
        p += 0.05 * Vec3(std::sin(2 * y + z), std::sin(2 * z + x), std::cos(2 * x - y));
    }
    std::mt19937 random(7);
    for (Vec3& p : image.positions)
        for (int k = 0; k < 3; ++k) p[k] += noise * (double(random()) / 4294967296.0 - 0.5);
    return image;
}

}  // namespace gim::test
