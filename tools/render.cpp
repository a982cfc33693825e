#include "tools/render.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tools/canvas.h"

namespace gim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDistance = 4.5;  // from the eye to the centre, in radii of the model: a long lens
constexpr double kFilled = 0.92;   // part of the picture's side that the model fills
const Vector3d kFront(0.80, 0.76, 0.70);
const Vector3d kBack(0.80, 0.35, 0.28);
const Vector3d kCut(0.85, 0.08, 0.10);
constexpr double kCutPen = 0.9;     // radius, pixels
constexpr float kCutBehind = 0.3F;  // how much of a hidden cut shines through

// With defects painted, only defects are red or yellow.
const Vector3d kPlain(0.84, 0.85, 0.86);
const Vector3d kPlainBack(0.50, 0.58, 0.70);
const Vector3d kOffBy20(0.98, 0.92, 0.58);
const Vector3d kOffBy45(0.96, 0.56, 0.12);
const Vector3d kFolded(0.90, 0.03, 0.06);
const Vector3d kFoldedBack(0.42, 0.0, 0.05);
const Vector3d kSqueezed(0.13, 0.35, 0.75);
const Vector3d kFair(0.96, 0.96, 0.95);
const Vector3d kSpread(0.90, 0.47, 0.10);

Vector3d at(const TriangleMesh& mesh, uint32_t v) {
    return {mesh.positions[v][0], mesh.positions[v][1], mesh.positions[v][2]};
}

bool is_finite(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
    return at(mesh, t[0]).allFinite() && at(mesh, t[1]).allFinite() && at(mesh, t[2]).allFinite();
}

struct Bounds {
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
    Vector3d high = -low;
};

Bounds bounds_of(const TriangleMesh& mesh) {
    Bounds bounds;
    for (const auto& t : mesh.triangles) {
        if (!is_finite(mesh, t)) continue;
        for (const uint32_t v : t) {
            bounds.low = bounds.low.cwiseMin(at(mesh, v));
            bounds.high = bounds.high.cwiseMax(at(mesh, v));
        }
    }
    return bounds;
}

// Rows: right, up, towards the eye.
Matrix3d camera_axes(const View& view, const Vector3d& extent) {
    UpAxis up = view.up;
    if (up == UpAxis::kAuto) up = extent.z() < 0.4 * std::min(extent.x(), extent.y()) ? UpAxis::kZ : UpAxis::kY;
    // The model's axes in the order right, up, front.
    Matrix3d turn = Matrix3d::Identity();
    if (up == UpAxis::kZ) turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    if (up == UpAxis::kX) turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    const double a = view.azimuth * std::numbers::pi / 180;
    const double e = view.elevation * std::numbers::pi / 180;
    Matrix3d about_up;
    about_up << std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a);
    Matrix3d about_right;
    about_right << 1, 0, 0, 0, std::cos(e), -std::sin(e), 0, std::sin(e), std::cos(e);
    return about_right * about_up * turn;
}

// The mesh's own normals, or else area-weighted vertex normals, in camera axes.
std::vector<Vector3d> smooth_normals(const TriangleMesh& mesh, const Matrix3d& axes,
                                     const std::vector<Vector3d>& seen) {
    if (!mesh.shading.empty()) {
        std::vector<Vector3d> own;
        for (const auto& n : mesh.shading.normals) own.push_back(axes * Eigen::Vector3f(n.data()).cast<double>());
        return own;
    }
    std::vector<Vector3d> normals(seen.size(), Vector3d::Zero());
    for (const auto& t : mesh.triangles) {
        const Vector3d area = (seen[t[1]] - seen[t[0]]).cross(seen[t[2]] - seen[t[0]]);
        if (!area.allFinite()) continue;
        for (const uint32_t v : t) normals[v] += area;
    }
    return normals;
}

// Returns the linear light of a surface point of this colour. Its normal is in camera axes; if it looks away, the
// surface is lit from its other side.
Vector3d shade(Vector3d normal, const Vector3d& colour) {
    const double length = normal.norm();
    normal = length > 0 ? Vector3d(normal / length) : Vector3d::UnitZ();
    if (normal.z() < 0) normal = -normal;
    const Vector3d albedo = linear(colour);

    static const Vector3d key = Vector3d(-0.45, 0.65, 0.62).normalized();
    static const Vector3d fill = Vector3d(0.75, 0.05, 0.55).normalized();
    const double wrapped = std::max(0.0, (normal.dot(key) + 0.15) / 1.15);
    const double sky = 0.5 + 0.5 * normal.y();
    const double diffuse = 0.95 * wrapped + 0.22 * std::max(0.0, normal.dot(fill)) + 0.10 + 0.14 * sky;
    const Vector3d half = (key + Vector3d::UnitZ()).normalized();
    const double gloss = 0.10 * std::pow(std::max(0.0, normal.dot(half)), 24);
    return albedo * diffuse + Vector3d::Constant(gloss);
}

// A mesh as the camera sees it.
struct Scene {
    std::vector<Vector3d> seen;     // in camera axes, centred, the model's radius is 1
    std::vector<Vector2d> pixels;   // in samples of the canvas
    std::vector<Vector3d> normals;  // of vertices, or the mesh's own; empty if shading is flat

    bool empty() const { return seen.empty(); }
    Corner corner(uint32_t v) const {
        return {pixels[v], 1 / (kDistance - seen[v].z())};  // 1 / distance is linear over the picture
    }
    std::array<Corner, 3> corners(const std::array<uint32_t, 3>& t) const {
        return {corner(t[0]), corner(t[1]), corner(t[2])};
    }
};

// Applies perspective, then the largest scale at which everything is inside.
void project(const TriangleMesh& mesh, uint32_t side, Scene& scene) {
    scene.pixels.resize(scene.seen.size());
    Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
    Vector2d high = -low;
    for (size_t v = 0; v < scene.seen.size(); ++v) {
        scene.pixels[v] = Vector2d(scene.seen[v].x(), -scene.seen[v].y()) / (kDistance - scene.seen[v].z());
    }
    for (const auto& t : mesh.triangles) {
        if (!is_finite(mesh, t)) continue;
        for (const uint32_t v : t) {
            low = low.cwiseMin(scene.pixels[v]);
            high = high.cwiseMax(scene.pixels[v]);
        }
    }
    const double scale = kFilled * side / std::max((high - low).maxCoeff(), 1e-12);
    const Vector2d middle = 0.5 * (low + high);
    for (Vector2d& p : scene.pixels) p = scale * (p - middle) + Vector2d::Constant(0.5 * side);
}

// Returns an empty scene if the mesh has no extent.
Scene look_at(const TriangleMesh& mesh, const View& view, uint32_t side) {
    Scene scene;
    const Bounds bounds = bounds_of(mesh);
    const Vector3d extent = bounds.high - bounds.low;
    double radius = 0.5 * extent.norm();
    if (radius == 0 || std::isinf(radius)) radius = 0.5 * extent.stableNorm();  // squares left the range of doubles
    if (!(radius > 0) || !std::isfinite(radius)) return scene;
    const Matrix3d axes = camera_axes(view, extent);
    const Vector3d centre = 0.5 * (bounds.low + bounds.high);
    scene.seen.resize(mesh.positions.size());
    for (uint32_t v = 0; v < scene.seen.size(); ++v) scene.seen[v] = axes * (at(mesh, v) - centre) / radius;
    if (!view.flat) scene.normals = smooth_normals(mesh, axes, scene.seen);
    project(mesh, side, scene);
    return scene;
}

// Draws the surface. colour_at(triangle, weights, whether its front is seen) returns the colour of a point.
template <class ColourAt>
void draw_surface(const TriangleMesh& mesh, const Scene& scene, bool wire, const ColourAt& colour_at, Canvas& canvas) {
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        const auto& t = mesh.triangles[f];
        if (!is_finite(mesh, t)) continue;
        const Vector3d facet = (scene.seen[t[1]] - scene.seen[t[0]]).cross(scene.seen[t[2]] - scene.seen[t[0]]);
        std::array<Vector3d, 3> normal = {facet, facet, facet};
        const auto& normals = mesh.shading.empty() ? t : mesh.shading.corners[f];
        for (size_t k = 0; k < 3 && !scene.normals.empty(); ++k) {
            if (normals[k] == Shading::kFlat || !scene.normals[normals[k]].allFinite()) continue;
            if (scene.normals[normals[k]].norm() > 0) normal[k] = scene.normals[normals[k]].normalized();
        }
        // The triangle decides which side is seen, because an interpolated normal may lean over the silhouette.
        const bool front = facet.dot(Vector3d(0, 0, kDistance) - scene.seen[t[0]]) >= 0;
        for (Vector3d& n : normal) {
            if (front && n.z() < 0) n.z() = 0;
            if (!front && n.z() >= 0) n.z() = -1e-9;
        }
        const auto paint = [&](const std::array<double, 3>& weight) {
            return shade(weight[0] * normal[0] + weight[1] * normal[1] + weight[2] * normal[2],
                         colour_at(f, weight, front));
        };
        draw_triangle(scene.corners(t), wire, paint, canvas);
    }
}

}  // namespace

Picture render_mesh(const TriangleMesh& mesh, const View& view, std::span<const std::array<uint32_t, 2>> lines) {
    Canvas canvas(view.size);
    const Scene scene = look_at(mesh, view, canvas.side);
    if (scene.empty()) return average(canvas);
    const auto colour_at = [](size_t, const auto&, bool front) { return front ? kFront : kBack; };
    draw_surface(mesh, scene, view.wire, colour_at, canvas);
    if (!lines.empty()) {
        MarkMask mask(canvas.colour.size(), 0);
        for (const auto& line : lines) mark_line(scene.corner(line[0]), scene.corner(line[1]), kCutPen, canvas, mask);
        paint_marks(mask, kCut, kCutBehind, canvas);
    }
    return average(canvas);
}

Picture render_defects(const TriangleMesh& mesh, const DefectMap& defects, const View& view) {
    Canvas canvas(view.size);
    const Scene scene = look_at(mesh, view, canvas.side);
    if (scene.empty()) return average(canvas);
    const auto colour_at = [&](size_t f, const std::array<double, 3>& weight, bool front) {
        const auto& t = mesh.triangles[f];
        double off = 0;
        for (size_t k = 0; k < 3; ++k) off += weight[k] * static_cast<double>(defects.off[t[k]]);
        if (off > 20) return off > 45 ? kOffBy45 : kOffBy20;
        return front ? kPlain : kPlainBack;
    };
    draw_surface(mesh, scene, view.wire, colour_at, canvas);

    // Marks show through what lies just above them, because a fold often lies under the surface that it folds into.
    const double pen = std::max(1.6, view.size / 600.0), edge_pen = 0.6 * pen;
    MarkMask folded(canvas.colour.size(), 0), folded_back(canvas.colour.size(), 0);
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        if (defects.folded[f]) mark_triangle(scene.corners(mesh.triangles[f]), pen, canvas, folded);
    }
    for (const auto& [a, b] : defects.folded_back)
        mark_line(scene.corner(a), scene.corner(b), edge_pen, canvas, folded_back);
    paint_marks(folded, kFolded, 0, canvas);
    paint_marks(folded_back, kFoldedBack, 0, canvas);
    return average(canvas);
}

Picture render_map(const TriangleMesh& mesh, std::span<const std::array<double, 2>> uv, uint32_t size) {
    Canvas canvas(size);
    Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
    Vector2d high = -low;
    for (const auto& p : uv) {
        low = low.cwiseMin(Vector2d(p[0], p[1]));
        high = high.cwiseMax(Vector2d(p[0], p[1]));
    }
    const double scale = kFilled * canvas.side / std::max((high - low).maxCoeff(), 1e-12);
    const auto corner_at = [&](uint32_t v) {
        const Vector2d p(uv[v][0], uv[v][1]);
        return Corner{scale * (p - 0.5 * (low + high)) + Vector2d::Constant(0.5 * canvas.side), 0};
    };
    const auto space_area = [&](const std::array<uint32_t, 3>& t) {
        return (at(mesh, t[1]) - at(mesh, t[0])).cross(at(mesh, t[2]) - at(mesh, t[0])).norm();
    };
    const auto plane_area = [&](const std::array<uint32_t, 3>& t) {
        const Vector2d a(uv[t[0]][0], uv[t[0]][1]), b(uv[t[1]][0], uv[t[1]][1]), c(uv[t[2]][0], uv[t[2]][1]);
        return std::abs(cross(b - a, c - a));
    };
    double space = 0, plane = 0;
    for (const auto& t : mesh.triangles) space += space_area(t), plane += plane_area(t);
    for (const auto& t : mesh.triangles) {
        const double share = plane_area(t) * space / std::max(space_area(t) * plane, 1e-300);
        const double octaves = std::clamp(std::log2(std::max(share, 1e-30)) / 5, -1.0, 1.0);
        const Vector3d end = octaves < 0 ? kSqueezed : kSpread;
        const Vector3d colour = linear((1 - std::abs(octaves)) * kFair + std::abs(octaves) * end);
        const std::array<Corner, 3> corners = {corner_at(t[0]), corner_at(t[1]), corner_at(t[2])};
        draw_triangle(
            corners, mesh.triangles.size() < 10000, [&](const auto&) { return colour; }, canvas);
    }
    return average(canvas);
}

Picture render_images(std::span<const DecodedImage> images, uint32_t size) {
    Picture picture;
    picture.width = picture.height = size;
    picture.rgb.assign(size_t{3} * size * size, 255);
    std::array<float, 3> low = {};
    std::array<float, 3> high = {};
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (const DecodedImage& image : images) {
        for (size_t i = 0; i < image.grid.size(); ++i) {
            if (!image.is_defined(i / 3)) continue;
            low[i % 3] = std::min(low[i % 3], image.grid[i]);
            high[i % 3] = std::max(high[i % 3], image.grid[i]);
        }
    }
    const auto tiles =
        static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(std::max<size_t>(images.size(), 1)))));
    const uint32_t tile = size / tiles;
    for (size_t i = 0; i < images.size(); ++i) {
        const DecodedImage& image = images[i];
        const auto left = static_cast<uint32_t>(i % tiles) * tile;
        const auto top = static_cast<uint32_t>(i / tiles) * tile;
        const uint32_t longer = std::max(image.columns, image.rows);
        const uint32_t x_margin = (longer - image.columns) / 2, y_margin = (longer - image.rows) / 2;
        for (uint32_t y = 0; y < tile; ++y) {
            for (uint32_t x = 0; x < tile; ++x) {
                // Undefined samples and the margins of a rectangle stay white. Below zero wraps round.
                const auto row = static_cast<uint32_t>(uint64_t{y} * longer / tile) - y_margin;
                const auto column = static_cast<uint32_t>(uint64_t{x} * longer / tile) - x_margin;
                if (row >= image.rows || column >= image.columns) continue;
                const size_t sample = size_t{row} * image.columns + column;
                if (!image.is_defined(sample)) continue;
                for (size_t k = 0; k < 3; ++k) {
                    const float value = image.grid[3 * sample + k];
                    const float range = high[k] - low[k];
                    const float share = range > 0 ? (value - low[k]) / range : 0.5F;
                    picture.rgb[3 * (size_t{top + y} * size + left + x) + k] =
                        static_cast<uint8_t>(std::lround(255 * std::clamp(share, 0.0F, 1.0F)));
                }
            }
        }
    }
    return picture;
}

}  // namespace gim
