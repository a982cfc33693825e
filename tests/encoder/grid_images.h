// Small geometry images with known gluing, for the tests of the stages after sampling.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "encoder/charts/glue_charts.h"
#include "encoder/squares/square_image.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

inline Mesh mesh_of(const TriangleMesh& input) {
    Mesh mesh;
    for (const auto& p : input.positions) mesh.positions.emplace_back(p[0], p[1], p[2]);
    mesh.triangles = input.triangles;
    return mesh;
}

// `at` of (u, v) in the unit square: columns run along u, rows along v.
inline SquareImage image_of(uint32_t side, const Sideband& sideband, const std::function<Vec3(double, double)>& at) {
    SquareGrid grid{side, {}};
    for (uint32_t row = 0; row < side; ++row) {
        for (uint32_t column = 0; column < side; ++column) {
            grid.positions.push_back(at(double(column) / (side - 1), double(row) / (side - 1)));
        }
    }
    return glue_square(std::move(grid), sideband).value();
}

// A torus: opposite sides of the square are glued. The grid slants so that it misses the lines of a regular mesh.
inline SquareImage torus_image(uint32_t side, double radius, double tube_radius) {
    const Sideband sideband{2, 0, {{2, 1}, {3, 1}, {0, 1}, {1, 1}}};
    SquareImage image = image_of(side, sideband, [=](double u, double v) {
        const double wave = 0.02 * std::sin(2 * std::numbers::pi * (u + 2 * v));
        const double a = 2 * std::numbers::pi * (u + wave), b = 2 * std::numbers::pi * (v + wave + 0.1);
        const double from_axis = radius + tube_radius * std::cos(b);
        return Vec3(from_axis * std::cos(a), from_axis * std::sin(a), tube_radius * std::sin(b));
    });
    for (uint32_t k = 0; k < side; ++k) {
        image.at(side - 1, k) = image.at(0, k);
        image.at(k, side - 1) = image.at(k, 0);
    }
    image.at(side - 1, side - 1) = image.at(0, 0);
    return image;
}

// The gluing of an image with a valid mask and valid seams.
inline void glue(MultiChartImage& image) { image.gluing = glue_charts(image.mask, image.seams).value(); }

// A sphere of radius 1 as two charts of side x side samples, a column apart, zipped all around. The first lacks its
// lower left corner, so that a cell has three samples. Its second sample is the same surface point as its first.
inline MultiChartImage sphere_charts(uint32_t side) {
    MultiChartImage image;
    const uint32_t width = 2 * side + 1, length = 2 * (side - 1);
    image.mask = {width, side, std::vector<uint8_t>(size_t{width} * side, 1)};
    for (uint32_t row = 0; row < side; ++row) {
        image.mask.defined[row * width + side] = 0;
        for (uint32_t column = 0; column < width; ++column) {
            // The second chart is the mirror image of the first, on the other side of the sphere.
            const uint32_t mirrored = std::min(column, width - 1 - column);
            const double x = 2.0 * mirrored / (side - 1) - 1, y = 2.0 * row / (side - 1) - 1;
            const double from_pole = 0.5 * std::numbers::pi * std::max(std::abs(x), std::abs(y));
            const double scale = x != 0 || y != 0 ? std::sin(from_pole) / std::hypot(x, y) : 0;
            image.positions.emplace_back(scale * x, scale * y, (column < side ? -1 : 1) * std::cos(from_pole));
        }
    }
    image.mask.defined[(side - 1) * width] = 0;
    image.seams.loops = {{0, 2}, {width - 1, 2}};
    image.seams.paths = {{3, length}, {2, length - 1}, {1, length}, {0, length}};
    image.seams.zippers.assign(2, std::vector<ZipStep>(length, ZipStep::kBoth));
    image.seams.zippers[0].front() = ZipStep::kFirst;
    image.seams.zippers[0].insert(image.seams.zippers[0].begin() + 1, ZipStep::kSecond);
    image.seams.zippers[1][length / 2] = ZipStep::kSecond;
    for (size_t i = 0; i < image.positions.size(); ++i) {
        if (!image.mask.defined[i]) image.positions[i] = Vec3::Zero();
    }
    glue(image);
    for (size_t i = 0; i < image.positions.size(); ++i) {
        if (image.mask.defined[i]) image.positions[i] = image.positions[image.gluing.representative[i]];
    }
    return image;
}

// A square with one path all around: its rim is the boundary of the surface.
inline Sideband open_sideband() { return {2, 0, {{kNoMate, 4}}}; }

}  // namespace gim
