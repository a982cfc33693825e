#include "tools/polygons.h"

#include <algorithm>
#include <cmath>

namespace gim {
namespace {

using Point2 = std::array<double, 2>;

// Ear clipping costs up to O(n^3). A face with more corners than this becomes a fan.
constexpr size_t kMaxClippedCorners = 256;

double cross(const Point2& a, const Point2& b, const Point2& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Projects the face along the main axis of its mean normal (Newell), so that its outline runs counter-clockwise.
std::vector<Point2> flatten(const std::vector<std::array<double, 3>>& positions, std::span<const uint32_t> face) {
    std::array<double, 3> normal = {};
    for (size_t i = 0; i < face.size(); ++i) {
        const std::array<double, 3>& a = positions[face[i]];
        const std::array<double, 3>& b = positions[face[(i + 1) % face.size()]];
        for (size_t k = 0; k < 3; ++k) {
            normal[k] += (a[(k + 1) % 3] - b[(k + 1) % 3]) * (a[(k + 2) % 3] + b[(k + 2) % 3]);
        }
    }
    size_t axis = 0;  // of the largest component; dropping it distorts least
    for (size_t k = 1; k < 3; ++k) {
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    }
    const size_t u = normal[axis] >= 0 ? (axis + 1) % 3 : (axis + 2) % 3;
    const size_t v = normal[axis] >= 0 ? (axis + 2) % 3 : (axis + 1) % 3;
    std::vector<Point2> flat(face.size());
    for (size_t i = 0; i < face.size(); ++i) flat[i] = {positions[face[i]][u], positions[face[i]][v]};
    return flat;
}

bool is_convex(const std::vector<Point2>& flat) {
    const size_t n = flat.size();
    for (size_t i = 0; i < n; ++i) {
        if (!(cross(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) > 0)) return false;
    }
    return true;
}

// True if corner i can be cut off: it is convex, and no other corner lies in its triangle.
bool is_ear(const std::vector<Point2>& flat, const std::vector<size_t>& left, size_t i) {
    const size_t n = left.size();
    const size_t ia = left[(i + n - 1) % n];
    const size_t ib = left[i];
    const size_t ic = left[(i + 1) % n];
    if (!(cross(flat[ia], flat[ib], flat[ic]) > 0)) return false;
    for (const size_t j : left) {
        if (j == ia || j == ib || j == ic) continue;
        const Point2& p = flat[j];
        if (cross(flat[ia], flat[ib], p) >= 0 && cross(flat[ib], flat[ic], p) >= 0 &&
            cross(flat[ic], flat[ia], p) >= 0) {
            return false;
        }
    }
    return true;
}

// Three corners of a face, as indices into the face.
using LocalTriangle = std::array<uint32_t, 3>;

void clip_ears(const std::vector<Point2>& flat, std::vector<LocalTriangle>& triangles) {
    std::vector<size_t> left(flat.size());
    for (size_t i = 0; i < left.size(); ++i) left[i] = i;
    while (left.size() > 3) {
        size_t ear = 0;
        while (ear < left.size() && !is_ear(flat, left, ear)) ++ear;
        if (ear == left.size()) ear = 1;  // self-crossing or flat: any triangle is as good
        const size_t n = left.size();
        triangles.push_back({static_cast<uint32_t>(left[(ear + n - 1) % n]), static_cast<uint32_t>(left[ear]),
                             static_cast<uint32_t>(left[(ear + 1) % n])});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back(
        {static_cast<uint32_t>(left[0]), static_cast<uint32_t>(left[1]), static_cast<uint32_t>(left[2])});
}

void cut_face(const std::vector<std::array<double, 3>>& positions, std::span<const uint32_t> face,
              std::vector<LocalTriangle>& triangles) {
    triangles.clear();
    if (face.size() > 3 && face.size() <= kMaxClippedCorners) {
        const std::vector<Point2> flat = flatten(positions, face);
        if (!is_convex(flat)) return clip_ears(flat, triangles);
    }
    for (uint32_t i = 2; i < face.size(); ++i) triangles.push_back({0, i - 1, i});
}

// Adds the colours of the triangle with these corners of face f. first: index of the face in soup.corners.
void add_appearance(const PolygonSoup& soup, size_t f, size_t first, const LocalTriangle& local,
                    const std::array<uint32_t, 3>& triangle, Appearance& appearance) {
    const uint32_t texture = soup.face_texture.empty() ? UINT32_MAX : soup.face_texture[f];
    if (!soup.face_texture.empty()) appearance.triangle_texture.push_back(texture);
    if (!soup.corner_texcoords.empty()) {
        const auto& uv = soup.corner_texcoords;
        appearance.corner_texcoords.push_back({uv[first + local[0]], uv[first + local[1]], uv[first + local[2]]});
    }
    if (!soup.vertex_colors.empty() || !soup.face_colors.empty()) {
        constexpr std::array<float, 3> kWhite = {1, 1, 1};
        const auto color = [&](uint32_t v) {
            if (texture != UINT32_MAX && !soup.colors_tint_textures) return kWhite;
            return soup.vertex_colors.empty() ? soup.face_colors[f] : soup.vertex_colors[v];
        };
        appearance.corner_colors.push_back({color(triangle[0]), color(triangle[1]), color(triangle[2])});
    }
}

// The normals of the triangle with these corners of a face. first: index of the face in soup.corners.
std::array<uint32_t, 3> normals_of(const PolygonSoup& soup, size_t first, const LocalTriangle& local,
                                   const std::array<uint32_t, 3>& triangle) {
    const auto& of_corner = soup.corner_normals;
    if (of_corner.empty()) return triangle;
    return {of_corner[first + local[0]], of_corner[first + local[1]], of_corner[first + local[2]]};
}

// Whether a face has another colour than white.
bool has_tint(const std::vector<std::array<float, 3>>& colors) {
    constexpr std::array<float, 3> kWhite = {1, 1, 1};
    return std::any_of(colors.begin(), colors.end(), [&](const auto& c) { return c != kNoColor && c != kWhite; });
}

}  // namespace

void scale_colors(std::vector<std::array<float, 3>>& colors) {
    constexpr float kRounding = 2;  // of colours in 0..255, such a file would be black
    float most = 0;
    for (const std::array<float, 3>& color : colors) {
        for (const float c : color) most = c > most ? c : most;
    }
    const float white = most <= kRounding ? 1.0f : most <= 255 ? 255.0f : 65535.0f;
    for (std::array<float, 3>& color : colors) {
        if (color == kNoColor) color = {white, white, white};
        for (float& c : color) c = c > 0 ? std::min(c / white, 1.0f) : 0.0f;
    }
}

uint64_t vertex_memory(const ReadContext& context) {
    return sizeof(std::array<double, 3>) + (context.textures ? sizeof(std::array<float, 3>) : 0) +
           (context.shading ? sizeof(std::array<float, 3>) : 0);
}

uint64_t corner_memory(const ReadContext& context) {
    constexpr uint64_t kShape = sizeof(int64_t) + sizeof(std::array<uint32_t, 3>);  // a triangle each, at most
    constexpr uint64_t kLook = sizeof(Appearance{}.corner_colors[0]) + sizeof(Appearance{}.corner_texcoords[0]) +
                               sizeof(uint32_t) + sizeof(std::array<float, 2>);
    // Normals of smoothing groups are made of sorted corners.
    constexpr uint64_t kShading = 2 * sizeof(uint64_t) + sizeof(std::array<float, 3>) + 3 * sizeof(uint32_t);
    return kShape + (context.textures ? kLook : 0) + (context.shading ? kShading : 0);
}

Result<void> take_memory(uint64_t vertices, uint64_t corners, ReadContext& context) {
    Result<void> fits =
        context.memory.take(vertices, vertex_memory(context), "its " + std::to_string(vertices) + " vertices");
    if (!fits.ok()) return fits;
    return context.memory.take(corners, corner_memory(context),
                               "the " + std::to_string(corners) + " corners of its faces");
}

Result<TriangleMesh> triangulate(PolygonSoup soup, ReadContext& context) {
    const auto vertex_count = static_cast<int64_t>(soup.positions.size());
    if (soup.positions.empty()) return Error{Stage::kInput, "it has no vertices"};
    if (soup.sizes.empty()) return Error{Stage::kInput, "it has vertices but no faces (a point cloud?)"};
    if (vertex_count > int64_t{UINT32_MAX} - 1) return Error{Stage::kInput, "it has more than 2^32 - 2 vertices"};

    TriangleMesh mesh;
    mesh.triangles.reserve(soup.sizes.size());
    // Texture coordinates without a texture have no use.
    if (std::all_of(soup.face_texture.begin(), soup.face_texture.end(), [](uint32_t t) { return t == UINT32_MAX; })) {
        soup.face_texture.clear();
        soup.corner_texcoords.clear();
    }
    const bool is_colored = !soup.face_texture.empty() || !soup.vertex_colors.empty() || !soup.face_colors.empty();
    if (!soup.vertex_colors.empty() && has_tint(soup.face_colors))
        context.warnings.push_back("both its vertices and its faces have colours; those of the vertices are used");
    std::vector<uint32_t> face;
    std::vector<LocalTriangle> pieces;
    size_t first = 0, dropped = 0;
    for (size_t f = 0; f < soup.sizes.size(); ++f) {
        const uint32_t size = soup.sizes[f];
        face.clear();
        for (uint32_t i = 0; i < size; ++i) {
            const int64_t corner = soup.corners[first + i];
            if (corner < 0 || corner >= vertex_count) {
                return Error{Stage::kInput, "face " + std::to_string(f) + " uses vertex " + std::to_string(corner) +
                                                " (both counted from 0), but there are only " +
                                                std::to_string(vertex_count) + " vertices"};
            }
            face.push_back(static_cast<uint32_t>(corner));
        }
        dropped += size < 3 ? 1 : 0;
        cut_face(soup.positions, face, pieces);
        for (const LocalTriangle& piece : pieces) {
            mesh.triangles.push_back({face[piece[0]], face[piece[1]], face[piece[2]]});
            if (is_colored) add_appearance(soup, f, first, piece, mesh.triangles.back(), mesh.appearance);
            if (!soup.normals.empty())
                mesh.shading.corners.push_back(normals_of(soup, first, piece, mesh.triangles.back()));
        }
        first += size;
    }
    if (mesh.triangles.empty()) return Error{Stage::kInput, "none of its faces has three corners"};
    if (dropped > 0) {
        context.warn(std::to_string(dropped) + (dropped == 1 ? " face" : " faces") +
                     " with fewer than three corners left out");
    }
    if (!soup.face_texture.empty()) mesh.appearance.textures = std::move(context.textures->images);
    mesh.positions = std::move(soup.positions);
    mesh.shading.normals = std::move(soup.normals);
    return mesh;
}

}  // namespace gim
