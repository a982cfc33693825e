#include "tests/gpu/expand_patches.h"

#include <algorithm>
#include <cstdlib>
#include <map>

namespace gim::test {
namespace {

std::array<float, 3> position_of(const SurfaceData& surface, const Sample& at) {
    const float* p = &surface.positions[3 * (size_t{at[1]} * surface.width + at[0])];
    return {p[0], p[1], p[2]};
}

float squared_distance(const SurfaceData& surface, const Sample& a, const Sample& b) {
    const auto p = position_of(surface, a), q = position_of(surface, b);
    return (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]);
}

bool is_split_from_first(const Sample& low, uint32_t size, const SurfaceData& surface) {
    bool is_first[2], is_last[2];
    for (size_t a = 0; a < 2; ++a) {
        const uint32_t in_tile = low[a] % surface.slot;
        is_first[a] = in_tile == 0;
        is_last[a] = in_tile + size == surface.slot - 1;
    }
    if ((is_first[0] || is_last[0]) && (is_first[1] || is_last[1])) return is_first[0] == is_first[1];
    const uint32_t right = low[0] + size, down = low[1] + size;
    return squared_distance(surface, low, {right, down}) <= squared_distance(surface, {right, low[1]}, {low[0], down});
}

// Walks around the cell, with a stop in the middle of each border that is finer.
std::vector<Sample> rim_of(const Sample& low, uint32_t size, uint32_t finer) {
    const Sample corners[5] = {
        low, {low[0] + size, low[1]}, {low[0] + size, low[1] + size}, {low[0], low[1] + size}, low};
    std::vector<Sample> rim;
    for (uint32_t k = 0; k < 4; ++k) {
        rim.push_back(corners[k]);
        if (finer >> k & 1)
            rim.push_back({(corners[k][0] + corners[k + 1][0]) / 2, (corners[k][1] + corners[k + 1][1]) / 2});
    }
    return rim;
}

void add_cell(const Sample& low, uint32_t size, uint32_t finer, const SurfaceData& surface,
              std::vector<SampleTriangle>* out) {
    const std::vector<Sample> rim = rim_of(low, size, finer);
    if (rim.size() > 4) {
        const Sample centre = {low[0] + size / 2, low[1] + size / 2};
        for (size_t i = 0; i < rim.size(); ++i) out->push_back({rim[i], rim[(i + 1) % rim.size()], centre});
    } else if (is_split_from_first(low, size, surface)) {
        out->push_back({rim[0], rim[1], rim[2]});
        out->push_back({rim[0], rim[2], rim[3]});
    } else {
        out->push_back({rim[1], rim[2], rim[3]});
        out->push_back({rim[1], rim[3], rim[0]});
    }
}

}  // namespace

std::vector<SampleTriangle> expand_patches(std::span<const gim_patch> patches, const SurfaceData& surface,
                                           uint32_t extra) {
    std::vector<SampleTriangle> out;
    for (const gim_patch& p : patches) {
        const uint32_t side = 1u << p.side, coarse = side >> p.inside;
        const uint32_t size = std::max(coarse >> extra, 1u);
        for (uint32_t row = 0; row < side; row += size) {
            for (uint32_t column = 0; column < side; column += size) {
                const uint32_t on_border = (row == 0 ? 1u : 0) | (column + size == side ? 2u : 0) |
                                           (row + size == side ? 4u : 0) | (column == 0 ? 8u : 0);
                const uint32_t finer = size > 1 ? p.finer & on_border : 0;
                add_cell({p.column + column, p.row + row}, size, finer, surface, &out);
            }
        }
    }
    return out;
}

std::vector<SoftTriangle> placed(std::span<const SampleTriangle> triangles, const SurfaceData& surface) {
    std::vector<SoftTriangle> out(triangles.size());
    for (size_t i = 0; i < triangles.size(); ++i) {
        for (size_t k = 0; k < 3; ++k) {
            const Sample& at = triangles[i][k];
            out[i].positions[k] = position_of(surface, at);
            for (size_t a = 0; a < 2; ++a) {
                const uint32_t tile = at[a] / surface.slot, in_tile = at[a] % surface.slot;
                out[i].texels[k][a] = tile * surface.slot_texels[a] + in_tile * surface.interval_texels[a];
            }
        }
    }
    return out;
}

uint64_t count_open_edges(std::span<const SoftTriangle> triangles) {
    std::map<std::array<float, 3>, uint32_t> numbers;
    std::map<std::pair<uint32_t, uint32_t>, int64_t> balance;  // of the uses of an edge in its two directions
    const auto number_of = [&](const std::array<float, 3>& place) {
        return numbers.emplace(place, static_cast<uint32_t>(numbers.size())).first->second;
    };
    for (const SoftTriangle& t : triangles) {
        std::array<uint32_t, 3> corner{};
        for (size_t k = 0; k < 3; ++k) corner[k] = number_of(t.positions[k]);
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = corner[k], b = corner[(k + 1) % 3];
            if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    }
    uint64_t open = 0;
    for (const auto& [edge, uses] : balance) open += static_cast<uint64_t>(std::abs(uses));
    return open;
}

}  // namespace gim::test
