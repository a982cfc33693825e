#include "encoder/squares/sample_square.h"

#include <algorithm>
#include <cmath>

#include "encoder/surface/stretch.h"

namespace gim {

namespace {

// Returns the row and column of ring sample p (order of format/sideband.h).
std::array<uint32_t, 2> ring_cell(uint32_t p, uint32_t side) {
    const uint32_t n = side - 1;
    if (p < n) return {0, p};
    if (p < 2 * n) return {p - n, n};
    if (p < 3 * n) return {n, 3 * n - p};
    return {4 * n - p, 0};
}

// Takes the samples along the opened boundary. A path with an earlier mate copies its mate's samples.
void sample_boundary(const SquareBoundary& boundary, SquareGrid& image) {
    const uint32_t side = image.side, total = 4 * (side - 1);
    const Sideband& sideband = boundary.sideband;
    const uint32_t scale = (side - 1) / (sideband.node_side - 1);
    std::vector<Vec3> ring(total);
    std::vector<uint32_t> begins;
    uint32_t begin = sideband.start * scale;
    for (size_t k = 0; k < sideband.paths.size(); ++k) {
        const uint32_t length = sideband.paths[k].length * scale;
        begins.push_back(begin);
        const uint32_t mate = sideband.paths[k].mate;
        if (mate < k) {
            const uint32_t mate_begin = begins[mate];
            for (uint32_t t = 0; t < length; ++t) ring[(begin + t) % total] = ring[(mate_begin + length - t) % total];
        } else {
            const std::vector<uint32_t>& loop = boundary.opened.loop;
            const size_t first = boundary.opened.paths[k].first;
            const size_t end = k + 1 < sideband.paths.size() ? boundary.opened.paths[k + 1].first : loop.size();
            const auto offset = [&](size_t i) {
                return i == end     ? double(length)
                       : i == first ? 0.0
                                    : std::fmod(boundary.ring[i] - begin + 2.0 * total, double(total));
            };
            size_t i = first;
            for (uint32_t t = 0; t <= length; ++t) {
                while (i + 1 < end && offset(i + 1) <= t) ++i;
                const double a = offset(i), b = offset(i + 1), s = std::clamp((t - a) / (b - a), 0.0, 1.0);
                const Vec3& p = boundary.opened.mesh.positions[loop[i]];
                const Vec3& q = boundary.opened.mesh.positions[loop[(i + 1) % loop.size()]];
                ring[(begin + t) % total] = s == 0 ? p : s == 1 ? q : Vec3(p + s * (q - p));
            }
        }
        begin += length;
    }
    for (uint32_t p = 0; p < total; ++p) {
        const auto [row, column] = ring_cell(p, side);
        image.at(row, column) = ring[p];
    }
}

}  // namespace

std::vector<SurfacePoint> locate_samples(const Mesh& mesh, const std::vector<Vec2>& uv, uint32_t side) {
    std::vector<SurfacePoint> found(size_t{side} * side);
    std::vector<double> best(found.size(), -1e-6);  // least barycentric coordinate so far; tolerates rounding
    const double n = side - 1;
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        const Vec2 a = uv[t[0]] * n, b = uv[t[1]] * n, c = uv[t[2]] * n;
        const Vec2 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
        const double area = twice_signed_area(a, b, c);
        if (!(area > 0)) continue;
        constexpr double kSlack = 1e-9;
        const auto first_column = static_cast<uint32_t>(std::max(0.0, std::ceil(low.x() - kSlack)));
        const auto first_row = static_cast<uint32_t>(std::max(0.0, std::ceil(low.y() - kSlack)));
        const auto last_column = static_cast<uint32_t>(std::min(n, std::floor(high.x() + kSlack)));
        const auto last_row = static_cast<uint32_t>(std::min(n, std::floor(high.y() + kSlack)));
        for (uint32_t row = first_row; row <= last_row; ++row) {
            for (uint32_t column = first_column; column <= last_column; ++column) {
                const Vec2 p(column, row);
                const std::array<double, 3> w{twice_signed_area(p, b, c) / area, twice_signed_area(a, p, c) / area,
                                              twice_signed_area(a, b, p) / area};
                const double least = std::min({w[0], w[1], w[2]});
                const size_t i = size_t{row} * side + column;
                if (least <= best[i]) continue;
                best[i] = least;
                found[i] = {f, w};
            }
        }
    }
    return found;
}

Result<SquareImage> sample_surface(const SquareBoundary& boundary, const std::vector<Vec2>& uv, uint32_t side) {
    SquareGrid grid{side, std::vector<Vec3>(size_t{side} * side, Vec3::Zero())};
    const Mesh& mesh = boundary.opened.mesh;
    const std::vector<SurfacePoint> points = locate_samples(mesh, uv, side);
    for (size_t i = 0; i < points.size(); ++i) {
        if (points[i].triangle == kNone) continue;
        Vec3 p = Vec3::Zero();
        for (size_t k = 0; k < 3; ++k)
            p += points[i].barycentric[k] * mesh.positions[mesh.triangles[points[i].triangle][k]];
        grid.positions[i] = p;
    }
    sample_boundary(boundary, grid);
    return glue_square(std::move(grid), boundary.sideband);
}

}  // namespace gim
