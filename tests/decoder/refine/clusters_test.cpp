// Clusters: every depth is the whole surface, and nothing that can be seen is ever culled.
#include "gim/clusters.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "tests/decoder/refine/refinable.h"
#include "tests/random_numbers.h"

namespace gim {
namespace {

using namespace gim::test;

using Point = std::array<double, 3>;

Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator*(double t, const Point& a) { return {t * a[0], t * a[1], t * a[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point point(const float* p) { return {p[0], p[1], p[2]}; }

using Corners = std::array<Point, 3>;

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
    const Point ab = b - a;
    const double squared = dot(ab, ab);
    const double t = squared > 0 ? std::clamp(dot(p - a, ab) / squared, 0.0, 1.0) : 0;
    return length(p - (a + t * ab));
}
double distance_to_triangle(const Point& p, const Corners& c) {
    double best = DBL_MAX;
    for (size_t i = 0; i < 3; ++i) best = std::min(best, distance_to_segment(p, c[i], c[(i + 1) % 3]));
    const Point n = cross(c[1] - c[0], c[2] - c[0]);
    bool is_above = dot(n, n) > 0;
    for (size_t i = 0; i < 3; ++i) is_above = is_above && dot(cross(c[(i + 1) % 3] - c[i], p - c[i]), n) >= 0;
    return is_above ? std::min(best, std::fabs(dot(p - c[0], n)) / length(n)) : best;
}
Point random_direction(Random& random) {
    for (;;) {
        const Point p = {between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)};
        const double l = length(p);
        if (l > 0.1 && l <= 1) return (1 / l) * p;
    }
}

struct Clusters {
    Refinable surface;
    gim_cluster_sizes sizes{};
    gim_cluster_tree tree{};
    std::vector<gim_cluster> clusters;
    std::vector<uint32_t> vertices;
    std::vector<uint8_t> triangles;

    Clusters(const std::string& name, uint32_t side, uint32_t level = 0) : surface(name, 0, level) {
        EXPECT_EQ(gim_read_cluster_sizes(surface.domain, side, &sizes), GIM_OK);
        clusters.resize(sizes.cluster_count);
        vertices.resize(sizes.vertex_count);
        triangles.resize(3 * size_t{sizes.triangle_count});
        const Block scratch(sizes.scratch_size);
        EXPECT_EQ(gim_decode_clusters(surface.domain, side, clusters.data(), vertices.data(), triangles.data(),
                                      scratch.get(), scratch.size(), &tree),
                  GIM_OK);
        EXPECT_LE(tree.cluster_count, sizes.cluster_count);
        EXPECT_LE(tree.vertex_count, sizes.vertex_count);
        EXPECT_EQ(tree.triangle_count, sizes.triangle_count);
        clusters.resize(tree.cluster_count);
    }

    std::vector<Face> faces(const gim_cluster& cluster) const {
        std::vector<uint32_t> indices(3 * size_t{cluster.triangle_count});
        gim_read_cluster_triangles(&cluster, 1, vertices.data(), triangles.data(), indices.data());
        std::vector<Face> all;
        for (size_t i = 0; i < indices.size(); i += 3) all.push_back({indices[i], indices[i + 1], indices[i + 2]});
        return all;
    }
    std::vector<Face> faces_of_depth(uint32_t depth) const {
        std::vector<Face> all;
        const gim_cluster_depth& d = tree.depths[depth];
        for (uint32_t i = 0; i < d.cluster_count; ++i) {
            for (const Face& face : faces(clusters[d.first_cluster + i])) all.push_back(face);
        }
        return all;
    }
    // Those of depth 0.
    void add_faces_below(const gim_cluster& cluster, std::vector<Face>* all) const {
        if (cluster.depth == 0) {
            for (const Face& face : faces(cluster)) all->push_back(face);
        }
        for (uint32_t c = 0; c < cluster.child_count; ++c) add_faces_below(clusters[cluster.first_child + c], all);
    }
    std::vector<Face> faces_below(const gim_cluster& cluster) const {
        std::vector<Face> all;
        add_faces_below(cluster, &all);
        return all;
    }
    Point position(uint32_t vertex) const { return point(&surface.positions[3 * size_t{vertex}]); }
    Corners corners(const Face& face) const { return {position(face[0]), position(face[1]), position(face[2])}; }
    std::vector<Corners> corners(const std::vector<Face>& faces) const {
        std::vector<Corners> all;
        for (const Face& face : faces) all.push_back(corners(face));
        return all;
    }
};

template <class F>
void for_each_example(const F& f) {
    std::vector<std::string> names(std::begin(kRefinables), std::end(kRefinables));
    names.push_back("tiles-pillow-lossless-20-bits");  // two tiles glued all around: diagonals must run through corners
    for (const std::string& name : names) {
        for (const uint32_t side : {8u, 4u}) {
            for (const uint32_t level : {0u, 1u}) {
                SCOPED_TRACE(name + ", side " + std::to_string(side) + ", level " + std::to_string(level));
                const Clusters c(name, side, level);
                if (::testing::Test::HasFailure()) return;
                f(c, side);
                if (::testing::Test::HasFatalFailure()) return;
            }
        }
    }
}

// The mesh of right triangles with two for each cell of so many samples. Sides of cells are its edges; diagonals may differ.
std::set<std::pair<uint32_t, uint32_t>> sides_of_cells(Refinable& r, uint32_t stride) {
    r.begin(static_cast<uint32_t>(r.shape.most_triangles));
    uint32_t splits = 0;
    for (uint32_t cell = r.shape.intervals; cell > stride; cell /= 2) splits += 2;
    for (uint32_t f = 0; f < r.count();) {
        if (r.level_of(f) < splits && gim_split(r.mesh, f) == GIM_OK) continue;
        ++f;
    }
    std::set<std::pair<uint32_t, uint32_t>> sides;
    for (uint32_t h = 0; h < 3 * r.count(); ++h) {
        const gim_half_edge edge = r.half_edge(h);
        if (edge.start[0] != edge.end[0] && edge.start[1] != edge.end[1]) continue;
        sides.insert(std::minmax(edge.vertex, r.half_edge(h % 3 == 2 ? h - 2 : h + 1).vertex));
    }
    return sides;
}

TEST(Clusters, EveryDepthIsTheWholeSurface) {
    for_each_example([](const Clusters& c, uint32_t) {
        Refinable r = Refinable(c.surface.name, 0, c.surface.level);
        const Topology base = topology_of(r);
        std::multiset<Face> coarsest;
        for (const Face& face : c.faces_of_depth(c.tree.mesh_depth_count - 1)) coarsest.insert(turned(face));
        EXPECT_EQ(coarsest, r.faces()) << "two triangles a tile, as gim_begin_refined has them";
        ASSERT_EQ(1u << (c.tree.mesh_depth_count - 1), r.shape.intervals);
        for (uint32_t depth = 0; depth < c.tree.mesh_depth_count; ++depth) {
            SCOPED_TRACE(depth);
            const uint32_t cells = r.shape.intervals >> depth;
            const std::vector<Face> faces = c.faces_of_depth(depth);
            ASSERT_EQ(faces.size(), 2 * size_t{r.shape.tile_count} * cells * cells);
            std::set<uint32_t> vertices;
            std::set<std::pair<uint32_t, uint32_t>> directed, edges;
            for (const Face& face : faces) {
                for (size_t i = 0; i < 3; ++i) {
                    const uint32_t from = face[i], to = face[(i + 1) % 3];
                    ASSERT_NE(from, to);
                    ASSERT_TRUE(directed.insert({from, to}).second) << "an edge twice in one direction";
                    edges.insert(std::minmax(from, to));
                    vertices.insert(from);
                }
            }
            const int64_t boundary = static_cast<int64_t>(2 * edges.size()) - static_cast<int64_t>(directed.size());
            EXPECT_EQ(boundary, base.boundary_edges * cells);
            EXPECT_EQ(static_cast<int64_t>(vertices.size()) - static_cast<int64_t>(edges.size()) +
                          static_cast<int64_t>(faces.size()),
                      base.euler);
            size_t sides = 0;
            for (const auto& side : sides_of_cells(r, 1u << depth)) {
                EXPECT_EQ(edges.count(side), 1u);
                ++sides;
            }
            EXPECT_EQ(edges.size(), sides + faces.size() / 2);
        }
    });
}

TEST(Clusters, AreOneTreeWithinLimits) {
    for_each_example([](const Clusters& c, uint32_t side) {
        const gim_cluster& root = c.clusters.back();
        EXPECT_EQ(root.parent, GIM_NOTHING);
        EXPECT_EQ(root.depth + 1, c.tree.depth_count);
        EXPECT_EQ(root.parent_error, FLT_MAX);
        uint32_t next_vertex = 0, next_triangle = 0;
        for (uint32_t i = 0; i < c.clusters.size(); ++i) {
            const gim_cluster& cluster = c.clusters[i];
            const bool has_triangles = cluster.depth < c.tree.mesh_depth_count;
            ASSERT_EQ(cluster.first_vertex, next_vertex);
            ASSERT_EQ(cluster.first_triangle, next_triangle);
            next_vertex += cluster.vertex_count;
            next_triangle += cluster.triangle_count;
            EXPECT_EQ(cluster.triangle_count > 0, has_triangles);
            EXPECT_LE(cluster.triangle_count, 2 * side * side);
            EXPECT_LE(cluster.vertex_count, side == 8 ? 130u : 34u);
            const std::vector<Face> faces = c.faces(cluster);
            std::set<uint32_t> used;
            for (const Face& face : faces) used.insert(face.begin(), face.end());
            EXPECT_EQ(used.size(), cluster.vertex_count) << "a vertex twice, or unused";
            EXPECT_EQ(cluster.first_child == GIM_NOTHING, cluster.depth == 0);
            EXPECT_EQ(cluster.child_count > 0, cluster.depth > 0);
            EXPECT_LE(cluster.child_count, 4u);
            for (uint32_t k = 0; k < cluster.child_count; ++k) {
                const gim_cluster& child = c.clusters.at(cluster.first_child + k);
                EXPECT_EQ(child.parent, i);
                EXPECT_EQ(child.depth + 1, cluster.depth);
                EXPECT_LE(child.error, cluster.error);
                EXPECT_EQ(child.parent_error, cluster.error);
                EXPECT_LE(length(point(child.center) - point(cluster.center)) + double{child.radius},
                          double{cluster.radius});
            }
            EXPECT_EQ(cluster.parent == GIM_NOTHING, i + 1 == c.clusters.size());
        }
        EXPECT_EQ(next_vertex, c.tree.vertex_count);
        EXPECT_EQ(next_triangle, c.tree.triangle_count);
    });
}

// As an engine does it, in binary32.
bool is_culled_by_cone(const gim_cluster& cluster, const float* eye) {
    float v[3];
    for (int k = 0; k < 3; ++k) v[k] = cluster.cone_apex[k] - eye[k];
    const float size = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    float cosine = 0;
    for (int k = 0; k < 3; ++k) cosine += v[k] / size * cluster.cone_axis[k];
    return cosine >= cluster.cone_cutoff;
}
bool is_culled_by_plane(const gim_cluster& cluster, const float* plane) {
    const float* c = cluster.center;
    return plane[0] * c[0] + plane[1] * c[1] + plane[2] * c[2] + plane[3] < -cluster.radius;
}
bool faces_the_eye(const Corners& c, const Point& eye) { return dot(cross(c[1] - c[0], c[2] - c[0]), eye - c[0]) > 0; }

// What is far away, near, and right at the edge of the cone.
std::array<float, 3> random_eye(const Clusters& c, const gim_cluster& cluster, Random& random) {
    const gim_cluster& root = c.clusters.back();
    Point eye = point(root.center) + (double{root.radius} * between(random, 0, 4)) * random_direction(random);
    const uint32_t kind = number_between(random, 0, 2);
    const double reach = double{cluster.radius} * std::pow(10.0, between(random, -3, 3));
    if (kind == 1) eye = point(cluster.cone_apex) - reach * random_direction(random);
    if (kind == 2) {
        const Point axis = point(cluster.cone_axis), other = random_direction(random);
        Point across = other - dot(other, axis) * axis;
        across = (1 / length(across)) * across;
        const double cosine = std::min(1.0, double{cluster.cone_cutoff} + between(random, -1e-3, 1e-3));
        eye = point(cluster.cone_apex) - reach * (cosine * axis + std::sqrt(1 - cosine * cosine) * across);
    }
    return {static_cast<float>(eye[0]), static_cast<float>(eye[1]), static_cast<float>(eye[2])};
}

#ifdef __SANITIZE_ADDRESS__
constexpr int kEyes = 10;
#else
constexpr int kEyes = 100;
#endif

TEST(Clusters, WhatFacesTheEyeIsNotCulledByItsCone) {
    Random random(11);
    uint64_t cones = 0, culled = 0, tests = 0;
    for_each_example([&](const Clusters& c, uint32_t) {
        for (const gim_cluster& cluster : c.clusters) {
            std::vector<Corners> all = c.corners(c.faces_below(cluster));
            for (const Corners& own : c.corners(c.faces(cluster))) all.push_back(own);
            const bool has_cone = cluster.cone_cutoff < 1;
            ASSERT_EQ(has_cone, length(point(cluster.cone_axis)) > 0.5);
            cones += has_cone;
            for (int i = 0; i < kEyes; ++i) {
                const std::array<float, 3> eye = random_eye(c, cluster, random);
                ++tests;
                if (!is_culled_by_cone(cluster, eye.data())) continue;
                ASSERT_TRUE(has_cone);
                ++culled;
                for (const Corners& face : all)
                    ASSERT_FALSE(faces_the_eye(face, point(eye.data()))) << "depth " << cluster.depth;
            }
        }
    });
    EXPECT_GT(cones, 100u);
    EXPECT_GT(culled, tests / 10);
}

TEST(Clusters, WhatTouchesTheFrustumIsNotCulledByItsBall) {
    Random random(12);
    uint64_t culled = 0, tests = 0;
    for_each_example([&](const Clusters& c, uint32_t) {
        const gim_cluster& root = c.clusters.back();
        for (const gim_cluster& cluster : c.clusters) {
            std::set<uint32_t> vertices;
            for (const Face& face : c.faces_below(cluster)) vertices.insert(face.begin(), face.end());
            for (const Face& face : c.faces(cluster)) vertices.insert(face.begin(), face.end());
            for (int i = 0; i < kEyes; ++i) {
                // A triangle that touches a frustum has a vertex inside of each of its planes. Half of the planes run
                // through a vertex.
                const Point normal = random_direction(random);
                Point through =
                    point(root.center) + (double{root.radius} * between(random, 0, 1)) * random_direction(random);
                if (i % 2 == 0)
                    through = c.position(*std::next(
                        vertices.begin(), number_between(random, 0, static_cast<uint32_t>(vertices.size() - 1))));
                float plane[4];
                for (size_t k = 0; k < 3; ++k) plane[k] = static_cast<float>(normal[k]);
                plane[3] = static_cast<float>(-dot(point(plane), through));
                ++tests;
                if (!is_culled_by_plane(cluster, plane)) continue;
                ++culled;
                for (const uint32_t v : vertices)
                    ASSERT_LT(dot(point(plane), c.position(v)) + double{plane[3]}, 0) << "depth " << cluster.depth;
            }
        }
    });
    EXPECT_GT(culled, tests / 20);
}

TEST(Clusters, BallsHoldAllBelow) {
    for_each_example([&](const Clusters& c, uint32_t) {
        for (const gim_cluster& cluster : c.clusters) {
            double farthest = 0;
            for (const auto& faces : {c.faces_below(cluster), c.faces(cluster)}) {
                for (const Face& face : faces) {
                    for (const uint32_t v : face)
                        farthest = std::max(farthest, length(c.position(v) - point(cluster.center)));
                }
            }
            ASSERT_LE(farthest, double{cluster.radius});
            if (cluster.depth > 0) continue;
            ASSERT_LE(double{cluster.radius}, farthest * 1.001);
        }
    });
}

double distance_to(const std::vector<Corners>& surface, const Point& p) {
    double best = DBL_MAX;
    for (const Corners& corners : surface) best = std::min(best, distance_to_triangle(p, corners));
    return best;
}

TEST(Clusters, NoSurfaceIsFartherFromTheOtherThanTheError) {
    Random random(13);
    uint64_t large = 0, tests = 0;
    for_each_example([&](const Clusters& c, uint32_t) {
        for (const gim_cluster& cluster : c.clusters) {
            if (cluster.depth >= c.tree.mesh_depth_count) {
                ASSERT_EQ(cluster.error, FLT_MAX);
                continue;
            }
            if (cluster.depth == 0) {
                ASSERT_EQ(cluster.error, 0);
                continue;
            }
            const std::vector<Corners> own = c.corners(c.faces(cluster)), below = c.corners(c.faces_below(cluster));
            // Mostly samples: the error is largest there.
            const auto compare = [&](const std::vector<Corners>& from, const std::vector<Corners>& to) {
                for (int i = 0; i < kEyes; ++i) {
                    const Corners& f = from[number_between(random, 0, static_cast<uint32_t>(from.size() - 1))];
                    const double x = i % 4 == 0 ? between(random, 0, 1) : 0;
                    const double y = i % 4 == 0 ? between(random, 0, 1 - x) : 0;
                    const double d = distance_to(to, f[0] + x * (f[1] - f[0]) + y * (f[2] - f[0]));
                    ASSERT_LE(d, double{cluster.error}) << "depth " << cluster.depth;
                    large += d > 0.1 * double{cluster.error};
                    ++tests;
                }
            };
            compare(below, own);
            compare(own, below);
            if (HasFatalFailure()) return;
        }
    });
    EXPECT_GT(large, tests / 20) << "the error says little";
}

TEST(Clusters, WrongArgumentsAndSmallMemoryAreRefused) {
    Refinable r("tiles-cube-lossy");
    gim_cluster_sizes sizes{};
    EXPECT_EQ(gim_read_cluster_sizes(r.domain, 7, &sizes), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_cluster_sizes(nullptr, 8, &sizes), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_cluster_sizes(r.domain, 8, nullptr), GIM_BAD_ARGUMENT);
    ASSERT_EQ(gim_read_cluster_sizes(r.domain, 8, &sizes), GIM_OK);
    std::vector<gim_cluster> clusters(sizes.cluster_count);
    std::vector<uint32_t> vertices(sizes.vertex_count);
    std::vector<uint8_t> triangles(3 * size_t{sizes.triangle_count});
    const Block scratch(sizes.scratch_size + 16);
    gim_cluster_tree tree;
    const auto decode = [&](const gim_domain* domain, uint32_t side, gim_cluster* c, uint32_t* v, uint8_t* t,
                            size_t offset, size_t size, gim_cluster_tree* to) {
        return gim_decode_clusters(domain, side, c, v, t, static_cast<uint8_t*>(scratch.get()) + offset, size, to);
    };
    gim_cluster* const c = clusters.data();
    uint32_t* const v = vertices.data();
    uint8_t* const t = triangles.data();
    const size_t size = sizes.scratch_size;
    EXPECT_EQ(decode(nullptr, 8, c, v, t, 0, size, &tree), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(r.domain, 16, c, v, t, 0, size, &tree), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(r.domain, 8, nullptr, v, t, 0, size, &tree), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(r.domain, 8, c, nullptr, t, 0, size, &tree), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(r.domain, 8, c, v, nullptr, 0, size, &tree), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(r.domain, 8, c, v, t, 0, size, nullptr), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(r.domain, 8, c, v, t, 4, size, &tree), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(r.domain, 8, c, v, t, 0, size - 1, &tree), GIM_SCRATCH_TOO_SMALL);
    EXPECT_EQ(gim_decode_clusters(r.domain, 8, c, v, t, nullptr, size, &tree), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(r.domain, 8, c, v, t, 0, size, &tree), GIM_OK);
}

TEST(CacheMisses, AreThoseOfACacheThatForgetsTheFirst) {
    // 0 1 2 miss, 3 misses; with room for 3, 0 is then forgotten.
    const uint32_t triangles[] = {0, 1, 2, 2, 1, 3, 3, 1, 0};
    uint32_t scratch[5];
    gim_cache_statistics s{};
    ASSERT_EQ(gim_count_cache_misses(triangles, 3, 5, 3, scratch, &s), GIM_OK);
    EXPECT_EQ(s.misses, 5u);
    EXPECT_FLOAT_EQ(s.acmr, 5.0f / 3);
    EXPECT_FLOAT_EQ(s.atvr, 5.0f / 4);
    ASSERT_EQ(gim_count_cache_misses(triangles, 3, 5, 4, scratch, &s), GIM_OK);
    EXPECT_EQ(s.misses, 4u);
    ASSERT_EQ(gim_count_cache_misses(triangles, 0, 5, 4, scratch, &s), GIM_OK);
    EXPECT_EQ(s.misses, 0u);
    EXPECT_EQ(s.acmr, 0);
    EXPECT_EQ(s.atvr, 0);
    EXPECT_EQ(gim_count_cache_misses(triangles, 3, 3, 4, scratch, &s), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_count_cache_misses(triangles, 3, 5, 0, scratch, &s), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_count_cache_misses(nullptr, 3, 5, 4, scratch, &s), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_count_cache_misses(triangles, 3, 5, 4, nullptr, &s), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_count_cache_misses(triangles, 3, 5, 4, scratch, nullptr), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_count_cache_misses(triangles, UINT32_MAX, 5, 4, scratch, &s), GIM_LIMIT_EXCEEDED);
}

// 8 x 8 cells have 81 vertices and 128 triangles. A cache of 16 needs no vertex of a cluster twice.
TEST(CacheMisses, AreFewInTheOrderOfClusters) {
    const Clusters c("tiles-one-lossy", 8);
    const gim_cluster_depth& finest = c.tree.depths[0];
    std::vector<uint32_t> indices(3 * size_t{finest.triangle_count});
    gim_read_cluster_triangles(c.clusters.data(), finest.cluster_count, c.vertices.data(), c.triangles.data(),
                               indices.data());
    std::vector<uint32_t> scratch(c.surface.shape.vertex_count);
    gim_cache_statistics s{};
    ASSERT_EQ(gim_count_cache_misses(indices.data(), finest.triangle_count, c.surface.shape.vertex_count, 16,
                                     scratch.data(), &s),
              GIM_OK);
    EXPECT_LE(s.acmr, 81.0f / 128 + 0.01f);
}

}  // namespace
}  // namespace gim
