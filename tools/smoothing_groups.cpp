#include "tools/smoothing_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "tools/text_scanner.h"

namespace gim {
namespace {

using Vector = std::array<double, 3>;

// The corners of a group at a vertex have one key.
struct Corner {
    uint64_t key = 0;
    uint32_t index = 0;  // in the soup's corners
    uint32_t face = 0;
};

// Returns the normal of a face (Newell), as long as twice its area. 0 0 0 if a corner is no vertex.
Vector face_normal(const PolygonSoup& soup, size_t first, uint32_t size) {
    Vector normal = {};
    for (uint32_t i = 0; i < size; ++i) {
        const int64_t from = soup.corners[first + i], to = soup.corners[first + (i + 1) % size];
        const auto is_vertex = [&](int64_t v) { return v >= 0 && static_cast<size_t>(v) < soup.positions.size(); };
        if (!is_vertex(from) || !is_vertex(to)) return {};
        const Vector &a = soup.positions[static_cast<size_t>(from)], &b = soup.positions[static_cast<size_t>(to)];
        for (size_t k = 0; k < 3; ++k)
            normal[k] += (a[(k + 1) % 3] - b[(k + 1) % 3]) * (a[(k + 2) % 3] + b[(k + 2) % 3]);
    }
    return normal;
}

std::array<float, 3> unit(const Vector& v) {
    const double length = std::hypot(v[0], v[1], v[2]);
    if (!(length > 0) || !std::isfinite(length)) return {};
    return {static_cast<float>(v[0] / length), static_cast<float>(v[1] / length), static_cast<float>(v[2] / length)};
}

// Corners of faces without a group are left out.
std::vector<Corner> corners_of_groups(const std::vector<uint32_t>& groups, const PolygonSoup& soup) {
    std::vector<Corner> corners;
    uint32_t index = 0;
    for (uint32_t f = 0; f < groups.size(); ++f) {
        for (uint32_t i = 0; i < soup.sizes[f]; ++i, ++index) {
            if (groups[f] != 0)
                corners.push_back({uint64_t{groups[f]} << 32 | static_cast<uint32_t>(soup.corners[index]), index, f});
        }
    }
    std::sort(corners.begin(), corners.end(),
              [](const Corner& a, const Corner& b) { return a.key != b.key ? a.key < b.key : a.index < b.index; });
    return corners;
}

}  // namespace

uint32_t smoothing_group_named(std::string_view word) {
    if (word == "on") return 1;
    const std::optional<int64_t> number = parse_integer(word);
    return number && *number > 0 && *number <= UINT32_MAX ? static_cast<uint32_t>(*number) : 0;
}

void add_group_normals(const std::vector<uint32_t>& groups, PolygonSoup& soup) {
    const bool is_same = std::adjacent_find(groups.begin(), groups.end(), std::not_equal_to<>()) == groups.end();
    if (is_same || soup.corners.size() >= Shading::kFlat) return;
    std::vector<Vector> of_face;
    size_t first = 0;
    for (const uint32_t size : soup.sizes) {
        of_face.push_back(face_normal(soup, first, size));
        first += size;
    }
    soup.corner_normals.clear();
    for (uint32_t f = 0; f < groups.size(); ++f) {
        soup.corner_normals.insert(soup.corner_normals.end(), soup.sizes[f], f);
        soup.normals.push_back(unit(of_face[f]));
    }
    const std::vector<Corner> corners = corners_of_groups(groups, soup);
    for (size_t begin = 0, end = 0; begin < corners.size(); begin = end) {
        Vector sum = {};
        for (; end < corners.size() && corners[end].key == corners[begin].key; ++end) {
            for (size_t k = 0; k < 3; ++k) sum[k] += of_face[corners[end].face][k];
            soup.corner_normals[corners[end].index] = static_cast<uint32_t>(soup.normals.size());
        }
        soup.normals.push_back(unit(sum));
    }
}

}  // namespace gim
