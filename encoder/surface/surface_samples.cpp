// Area-stratified points on a triangle mesh (surface_samples.h).
#include "encoder/surface/surface_samples.h"

#include <algorithm>
#include <cmath>

#include "encoder/base/parallel.h"

namespace gim {

namespace {

double unit_from_bits(uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

double fraction(double x) { return x - std::floor(x); }

// Folds the unit square onto the triangle u + v <= 1, evenly.
Vec2 fold(double u, double v) { return u + v <= 1 ? Vec2(u, v) : Vec2(1 - u, 1 - v); }

}  // namespace

SurfaceSamples sample_by_area(const Mesh& mesh, uint32_t count, uint64_t seed, uint32_t threads) {
    const size_t faces = mesh.triangles.size();
    std::vector<double> area_before(faces + 1, 0.0);
    parallel_blocks(faces, 16384, threads, [&](size_t, size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) area_before[f + 1] = face_area(mesh, static_cast<uint32_t>(f));
    });
    for (size_t f = 0; f < faces; ++f) area_before[f + 1] += area_before[f];

    SurfaceSamples samples;
    samples.area = area_before[faces];
    if (!(samples.area > 0) || !std::isfinite(samples.area)) return samples;
    samples.points.resize(count);
    samples.triangles.resize(count);
    samples.barycentrics.resize(count);

    // Powers of the plastic number. Their successive multiples fill the square evenly over every run of samples.
    constexpr double kStepU = 0.7548776662466927, kStepV = 0.5698402909980532;
    const uint64_t key = mix_bits(seed);
    const double shift_u = unit_from_bits(mix_bits(key ^ 1)), shift_v = unit_from_bits(mix_bits(key ^ 2));
    parallel_blocks(count, 8192, threads, [&](size_t, size_t begin, size_t end) {
        const double first = samples.area * (static_cast<double>(begin) / count);
        size_t f = static_cast<size_t>(std::upper_bound(area_before.begin() + 1, area_before.end(), first) -
                                       (area_before.begin() + 1));
        for (size_t k = begin; k < end; ++k) {
            const double jitter = unit_from_bits(mix_bits(key + 3 + k));
            const double at = samples.area * ((static_cast<double>(k) + jitter) / count);
            while (f + 1 < faces && area_before[f + 1] <= at) ++f;
            size_t chosen = std::min(f, faces - 1);
            while (chosen > 0 && area_before[chosen + 1] == area_before[chosen]) --chosen;  // rounding at the very end
            const auto order = static_cast<double>(k);
            const Vec2 b = fold(fraction(order * kStepU + shift_u), fraction(order * kStepV + shift_v));
            const Triangle& t = mesh.triangles[chosen];
            samples.triangles[k] = static_cast<uint32_t>(chosen);
            samples.barycentrics[k] = b;
            samples.points[k] =
                (1 - b[0] - b[1]) * mesh.positions[t[0]] + b[0] * mesh.positions[t[1]] + b[1] * mesh.positions[t[2]];
        }
    });
    return samples;
}

}  // namespace gim
