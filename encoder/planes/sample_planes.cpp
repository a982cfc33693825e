#include "encoder/planes/sample_planes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "encoder/base/parallel.h"
#include "encoder/image/gluing.h"
#include "encoder/surface/stretch.h"
#include "format/cell.h"
#include "format/plane_code.h"

namespace gim {

namespace {

constexpr size_t kBlock = 4096;
constexpr size_t kMostFacesForCreases = 64;  // a vertex with more is smooth, so that the cost stays linear

double corner_angle(const Mesh& mesh, uint32_t h) {
    const Vec3& p = mesh.positions[from(mesh, h)];
    const Vec3 a = mesh.positions[to(mesh, h)] - p, b = mesh.positions[from(mesh, prev(h))] - p;
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

Vec3 unit_or_zero(const Vec3& v) {
    const double length = v.norm();
    return length > 0 ? Vec3(v / length) : Vec3::Zero();
}

std::vector<Vec3> face_normals(const Mesh& mesh) {
    std::vector<Vec3> normals(mesh.triangles.size());
    for (size_t f = 0; f < normals.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        const Vec3& a = mesh.positions[t[0]];
        normals[f] = unit_or_zero((mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a));
    }
    return normals;
}

// Half-edges by the vertex that they leave: those of vertex v are at first[v] .. first[v+1]-1.
struct Corners {
    std::vector<uint32_t> first, half_edges;
};
Corners corners_of(const Mesh& mesh) {
    Corners c;
    c.first.assign(mesh.positions.size() + 1, 0);
    c.half_edges.resize(mesh.triangles.size() * 3);
    for (const Triangle& t : mesh.triangles) {
        for (const uint32_t v : t) ++c.first[v + 1];
    }
    for (size_t v = 0; v + 1 < c.first.size(); ++v) c.first[v + 1] += c.first[v];
    std::vector<uint32_t> at(c.first.begin(), c.first.end() - 1);
    for (uint32_t h = 0; h < c.half_edges.size(); ++h) c.half_edges[at[from(mesh, h)]++] = h;
    return c;
}

// Angle-weighted mean of the faces around a corner's vertex that are bent against the corner's own face by less than the
// crease angle.
std::vector<Vec3> corner_normals(const Mesh& mesh, uint32_t threads) {
    const std::vector<Vec3> faces = face_normals(mesh);
    const Corners corners = corners_of(mesh);
    const double least = std::cos(AttributeSource::kCreaseAngle * std::numbers::pi / 180);
    std::vector<Vec3> normals(mesh.triangles.size() * 3);
    parallel_blocks(mesh.positions.size(), kBlock, threads, [&](size_t, size_t begin, size_t end) {
        std::vector<double> angles;
        for (size_t v = begin; v < end; ++v) {
            const std::span<const uint32_t> around =
                std::span(corners.half_edges).subspan(corners.first[v], corners.first[v + 1] - corners.first[v]);
            Vec3 all = Vec3::Zero();
            angles.clear();
            for (const uint32_t h : around) {
                angles.push_back(corner_angle(mesh, h));
                all += angles.back() * faces[face_of(h)];
            }
            for (const uint32_t h : around) {
                const Vec3& own = faces[face_of(h)];
                Vec3 sum = all;
                if (around.size() <= kMostFacesForCreases && own.squaredNorm() > 0) {
                    sum.setZero();
                    for (size_t i = 0; i < around.size(); ++i) {
                        const Vec3& other = faces[face_of(around[i])];
                        if (own.dot(other) >= least) sum += angles[i] * other;
                    }
                }
                const Vec3 mean = unit_or_zero(sum);
                normals[h] = mean.squaredNorm() > 0 ? mean : own;
            }
        }
    });
    return normals;
}

// The image as a surface: points and outside directions at real grid coordinates.
class GridSurface {
  public:
    GridSurface(const GeometryImage& image, GridGluing gluing) : image_(image), gluing_(std::move(gluing)) {
        outside_.assign(image.positions.size(), Vec3::Zero());
        for (const Triangle& t : triangulate_grid(image.positions, gluing_).triangles) {
            const Vec3& a = image.positions[t[0]];
            const Vec3 n = (image.positions[t[1]] - a).cross(image.positions[t[2]] - a);
            for (const uint32_t v : t) outside_[gluing_.representative[v]] += n;
        }
        for (size_t v = 0; v < outside_.size(); ++v) outside_[v] = unit_or_zero(outside_[gluing_.representative[v]]);
    }

    struct Point {
        Vec3 position, outside;
        double spacing = 0;  // the cell's longer diagonal
    };
    // 0 .. side-1 each.
    Point at(double row, double column) const {
        const CellPoint place = locate_in_cell(image_.side, row, column);
        const auto& [a, b, c, d] = place.corners;
        const bool main = split_cell(image_.positions, gluing_, place.cell)[0][2] == d;
        const std::array<double, 4> w = place.weights(main);
        Point p{Vec3::Zero(), Vec3::Zero(), 0};
        for (size_t i = 0; i < 4; ++i) {
            p.position += w[i] * image_.positions[place.corners[i]];
            p.outside += w[i] * outside_[place.corners[i]];
        }
        p.outside = unit_or_zero(p.outside);
        p.spacing = std::max((image_.positions[a] - image_.positions[d]).norm(),
                             (image_.positions[b] - image_.positions[c]).norm());
        return p;
    }

  private:
    const GeometryImage& image_;
    GridGluing gluing_;
    std::vector<Vec3> outside_;
};

}  // namespace

AttributeSource::AttributeSource(const Mesh& mesh, uint32_t threads)
    : mesh_(mesh), tree_(mesh, threads), corner_normals_(corner_normals(mesh, threads)), threads_(threads) {}

Vec3 AttributeSource::face_normal(uint32_t face) const {
    const Triangle& t = mesh_.triangles[face];
    const Vec3& a = mesh_.positions[t[0]];
    return (mesh_.positions[t[1]] - a).cross(mesh_.positions[t[2]] - a);
}

// Searches again from further and further outside, as long as what is found looks the other way.
void AttributeSource::keep_to_the_right_side(const Vec3& query, const Vec3& outside, double spacing,
                                             ClosestPoint* found) const {
    if (face_normal(found->triangle).dot(outside) >= 0) return;
    const double first = std::max(std::sqrt(found->squared_distance), 0.125 * spacing);
    for (double offset = first; offset <= 8 * first; offset *= 2) {
        const ClosestPoint again = tree_.find(query + offset * outside, found->triangle);
        if (face_normal(again.triangle).dot(outside) <= 0) continue;
        // Nothing near looks the right way: a fold of the image, or the rim of an open surface.
        if ((again.point - query).norm() > 4 * first) return;
        *found = again;
        return;
    }
}

std::vector<ClosestPoint> AttributeSource::locate(const std::vector<Query>& queries) const {
    std::vector<Vec3> positions(queries.size());
    for (size_t i = 0; i < queries.size(); ++i) positions[i] = queries[i].position;
    std::vector<ClosestPoint> found = tree_.find_all(positions, threads_);
    parallel_blocks(queries.size(), kBlock, threads_, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            keep_to_the_right_side(queries[i].position, queries[i].outside, queries[i].spacing, &found[i]);
    });
    return found;
}

Result<std::vector<ClosestPoint>> AttributeSource::locate(const GeometryImage& image, uint32_t side) const {
    GIM_TRY(gluing, glue_ring(image.sideband, image.side));
    const GridSurface surface(image, std::move(gluing));
    const double scale = double(image.side - 1) / (side - 1);
    std::vector<Query> queries(size_t{side} * side);
    parallel_blocks(queries.size(), kBlock, threads_, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const size_t row = i / side, column = i % side;
            const auto p = surface.at(double(row) * scale, double(column) * scale);
            queries[i] = {p.position, p.outside, p.spacing};
        }
    });
    return locate(queries);
}

Result<AttributeSource::Texels> AttributeSource::locate(const MultiChartImage& image, uint32_t exponent) const {
    GIM_TRY(point, glue_samples(image.mask, image.seams));
    const uint32_t width = image.width(), per_sample = 1u << exponent;
    const auto columns = static_cast<uint32_t>(chart_plane_side(width, exponent)),
               rows = static_cast<uint32_t>(chart_plane_side(image.height(), exponent));
    const std::vector<CellTriangle> faces = triangles_of(image, point);
    std::vector<Vec3> outside(image.positions.size(), Vec3::Zero());
    for (const CellTriangle& face : faces) {
        const auto& [a, b, c] = face.corners;
        const Vec3 normal = (image.positions[b] - image.positions[a]).cross(image.positions[c] - image.positions[a]);
        for (const uint32_t v : face.corners) outside[point[v]] += normal;
    }
    // Texels by the faces that they lie in; those on an edge belong to the first.
    Texels result;
    std::vector<Query> queries;
    std::vector<bool> taken(size_t{columns} * rows, false);
    for (const CellTriangle& face : faces) {
        const uint32_t row = face.cell / (width - 1), column = face.cell % (width - 1);
        std::array<Vec2, 3> corner;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t i = face.corners[k] % width - column, j = face.corners[k] / width - row;
            corner[k] = Vec2(i, j);
        }
        const double area = twice_signed_area(corner[0], corner[1], corner[2]);
        for (uint32_t i = 0; i <= per_sample; ++i) {
            for (uint32_t j = 0; j <= per_sample; ++j) {
                const Vec2 p = Vec2(j, i) / per_sample;
                const std::array<double, 3> w{twice_signed_area(p, corner[1], corner[2]) / area,
                                              twice_signed_area(corner[0], p, corner[2]) / area,
                                              twice_signed_area(corner[0], corner[1], p) / area};
                if (std::min({w[0], w[1], w[2]}) < 0) continue;  // exact: all are multiples of 2^-k
                const uint32_t texel = (row * per_sample + i) * columns + column * per_sample + j;
                if (taken[texel]) continue;
                taken[texel] = true;
                Query query;
                for (size_t k = 0; k < 3; ++k) {
                    query.position += w[k] * image.positions[face.corners[k]];
                    query.outside += w[k] * unit_or_zero(outside[point[face.corners[k]]]);
                    query.spacing = std::max(
                        query.spacing,
                        (image.positions[face.corners[k]] - image.positions[face.corners[(k + 1) % 3]]).norm());
                }
                query.outside = unit_or_zero(query.outside);
                result.texels.push_back(texel);
                queries.push_back(query);
            }
        }
    }
    result.points = locate(queries);
    return result;
}

Vec3 AttributeSource::normal(const ClosestPoint& point) const {
    Vec3 n = Vec3::Zero();
    for (size_t i = 0; i < 3; ++i) n += point.barycentric[i] * corner_normals_[3 * size_t{point.triangle} + i];
    return unit_or_zero(n);
}

std::vector<float> AttributeSource::normals(std::span<const ClosestPoint> points) const {
    std::vector<float> values(points.size() * 3);
    parallel_blocks(points.size(), kBlock, threads_, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Vec3 n = normal(points[i]);
            for (int k = 0; k < 3; ++k) values[3 * i + static_cast<size_t>(k)] = static_cast<float>(n[k]);
        }
    });
    return values;
}

Result<bool> equalize_ring(const Sideband& sideband, uint32_t side, std::vector<float>& values) {
    GIM_TRY(gluing, glue_ring(sideband, side));
    for (size_t i = 0; i < gluing.representative.size(); ++i) {
        const size_t from = gluing.representative[i];
        if (from != i)
            std::copy_n(values.begin() + static_cast<ptrdiff_t>(3 * from), 3,
                        values.begin() + static_cast<ptrdiff_t>(3 * i));
    }
    return true;
}

}  // namespace gim
