// Surfaces that need no repair, or little, and that are hard to open into squares and charts: high genus, many
// boundaries, needles, thin parts, few faces, crowded vertices. Every one of them must come back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>

#include "corpus/generators.h"
#include "gim/encoder.h"
#include "tests/encoder/decoded_topology.h"
#include "tests/random_numbers.h"

namespace gim {
namespace {

using corpus::Point;

Point point_in(Random& random, double half) {
    return {between(random, -half, half), between(random, -half, half), between(random, -half, half)};
}
double distance_to_segment(const Point& p, const Point& a, const Point& b) {
    double along = 0, length = 0, squared = 0;
    for (int k = 0; k < 3; ++k) along += (p[k] - a[k]) * (b[k] - a[k]), length += (b[k] - a[k]) * (b[k] - a[k]);
    const double t = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0;
    for (int k = 0; k < 3; ++k) squared += std::pow(p[k] - a[k] - t * (b[k] - a[k]), 2);
    return std::sqrt(squared);
}

// Rods between random points, melted together: of random genus.
TriangleMesh rods(Random& random) {
    std::vector<std::pair<Point, Point>> segments;
    std::vector<Point> joints;
    const uint32_t count = number_between(random, 3, 24);
    for (uint32_t k = 0; k < count; ++k) joints.push_back(point_in(random, 0.8));
    for (uint32_t k = 0; k < 2 * count; ++k)
        segments.push_back(
            {joints[number_between(random, 0, count - 1)], joints[number_between(random, 0, count - 1)]});
    const double radius = between(random, 0.06, 0.15);
    const auto inside = [&](const Point& p) {
        double nearest = 10;
        for (const auto& [a, b] : segments) nearest = std::min(nearest, distance_to_segment(p, a, b));
        return radius - nearest;
    };
    return corpus::isosurface(inside, {1, 1, 1}, number_between(random, 8, 20));
}

// Balls that add up: smooth, with thin necks.
TriangleMesh blobs(Random& random) {
    std::vector<std::pair<Point, double>> balls;
    const uint32_t count = number_between(random, 2, 12);
    for (uint32_t k = 0; k < count; ++k) balls.push_back({point_in(random, 0.6), between(random, 0.02, 0.2)});
    const auto inside = [&](const Point& p) {
        double sum = -1;
        for (const auto& [centre, size] : balls)
            sum += size * size / (1e-9 + std::pow(distance_to_segment(p, centre, centre), 2));
        return sum;
    };
    return corpus::isosurface(inside, {1.5, 1.5, 1.5}, number_between(random, 6, 20));
}

TriangleMesh stretched(TriangleMesh mesh, const Point& factor) {
    for (Point& p : mesh.positions)
        for (int k = 0; k < 3; ++k) p[k] *= factor[k];
    return mesh;
}

// Removes random faces that share no vertex: each leaves a boundary.
TriangleMesh perforated(TriangleMesh mesh, Random& random, uint32_t holes) {
    std::vector<bool> taken(mesh.positions.size());
    std::set<uint32_t> gone;
    for (uint32_t k = 0; k < 8 * holes && gone.size() < holes; ++k) {
        const uint32_t f = number_between(random, 0, static_cast<uint32_t>(mesh.triangles.size()) - 1);
        const auto& t = mesh.triangles[f];
        if (taken[t[0]] || taken[t[1]] || taken[t[2]]) continue;
        for (const uint32_t v : t) taken[v] = true;
        gone.insert(f);
    }
    TriangleMesh result = mesh;
    result.triangles.clear();
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f)
        if (gone.count(f) == 0) result.triangles.push_back(mesh.triangles[f]);
    return result;
}

// Splits random faces at points that lie almost on an edge or a corner.
TriangleMesh with_needles(TriangleMesh mesh, Random& random, uint32_t count, double least) {
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t f = number_between(random, 0, static_cast<uint32_t>(mesh.triangles.size()) - 1);
        const auto t = mesh.triangles[f];
        const double a = std::pow(10, between(random, std::log10(least), -1)), b = between(random, 0.1, 0.9) * (1 - a);
        Point p;
        for (int i = 0; i < 3; ++i)
            p[i] = a * mesh.positions[t[0]][i] + b * mesh.positions[t[1]][i] + (1 - a - b) * mesh.positions[t[2]][i];
        const auto v = static_cast<uint32_t>(mesh.positions.size());
        mesh.positions.push_back(p);
        mesh.triangles[f] = {t[0], t[1], v};
        mesh.triangles.push_back({t[1], t[2], v});
        mesh.triangles.push_back({t[2], t[0], v});
    }
    return mesh;
}

// Pulls some vertices far out.
TriangleMesh with_spikes(TriangleMesh mesh, Random& random, uint32_t count, double factor) {
    for (uint32_t k = 0; k < count; ++k) {
        Point& p = mesh.positions[number_between(random, 0, static_cast<uint32_t>(mesh.positions.size()) - 1)];
        for (double& x : p) x *= factor;
    }
    return mesh;
}

// A double pyramid over a polygon; an open one is a fan.
TriangleMesh pyramid(Random& random, bool closed) {
    const uint32_t corners = number_between(random, 3, 2000);
    TriangleMesh mesh;
    mesh.positions = {{0, 0, between(random, 0.01, 3)}, {0, 0, -1}};
    for (uint32_t k = 0; k < corners; ++k) {
        const double angle = 2 * 3.14159265358979 * k / corners, radius = between(random, 0.5, 1);
        mesh.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), between(random, -0.1, 0.1)});
    }
    for (uint32_t k = 0; k < corners; ++k) {
        const uint32_t a = 2 + k, b = 2 + (k + 1) % corners;
        mesh.triangles.push_back({0, a, b});
        if (closed) mesh.triangles.push_back({1, b, a});
    }
    return mesh;
}

// A strip of triangles, up to very narrow; closed into a ring or not.
TriangleMesh strip(Random& random) {
    const uint32_t length = number_between(random, 1, 600);
    const double width = std::pow(10, between(random, -4, 0));
    const bool ring = length > 3 && random() % 2 == 0;
    TriangleMesh mesh;
    for (uint32_t k = 0; k <= length; ++k) {
        const double t = ring ? 2 * 3.14159265358979 * k / (length + 1) : double(k) / length;
        const Point p = ring ? Point{std::cos(t), std::sin(t), 0} : Point{t, 0, 0.1 * std::sin(9 * t)};
        mesh.positions.push_back({p[0], p[1], p[2] - width});
        mesh.positions.push_back({p[0], p[1], p[2] + width});
    }
    const uint32_t all = 2 * length + 2;
    for (uint32_t k = 0; k < (ring ? length + 1 : length); ++k) {
        const uint32_t a = 2 * k, b = a + 1, c = (a + 2) % all, d = (a + 3) % all;
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({b, c, d});
    }
    return mesh;
}

// The closed or open surface of a few random triangles that share edges.
TriangleMesh tiny(Random& random) {
    TriangleMesh mesh;
    for (int k = 0; k < 4; ++k) mesh.positions.push_back(point_in(random, 1));
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    mesh.triangles.resize(number_between(random, 1, 4));
    return random() % 2 == 0 ? mesh : with_needles(mesh, random, number_between(random, 1, 6), 1e-3);
}

// Several of them, of very different sizes.
TriangleMesh assembly(Random& random) {
    std::vector<TriangleMesh> parts;
    const uint32_t count = number_between(random, 2, 6);
    for (uint32_t k = 0; k < count; ++k) {
        const double size = std::pow(10, between(random, -2, 0));
        parts.push_back(
            stretched(random() % 3 == 0 ? corpus::torus(9, 7, 0.5, 0.2) : tiny(random), {size, size, size}));
    }
    return corpus::together(parts, 3);
}

struct Kind {
    const char* name;
    TriangleMesh (*make)(Random&);
};
const Kind kKinds[] = {
    {"rods", rods},
    {"blobs", blobs},
    {"thin",
     [](Random& r) {
         return stretched(blobs(r), {1, std::pow(10, between(r, -4, -1)), 1});
     }},
    {"long",
     [](Random& r) {
         return stretched(rods(r), {1, 1, std::pow(10, between(r, 1, 3))});
     }},
    {"rough", [](Random& r) { return corpus::roughened(blobs(r), between(r, 0.02, 0.2), r()); }},
    {"perforated", [](Random& r) { return perforated(blobs(r), r, number_between(r, 1, 40)); }},
    {"perforated rods", [](Random& r) { return perforated(rods(r), r, number_between(r, 1, 20)); }},
    {"needles", [](Random& r) { return with_needles(corpus::sphere(6), r, number_between(r, 20, 400), 1e-5); }},
    {"needled torus", [](Random& r) { return with_needles(corpus::torus(12, 8, 0.7, 0.25), r, 300, 1e-4); }},
    {"spikes",
     [](Random& r) { return with_spikes(corpus::sphere(8), r, number_between(r, 1, 20), between(r, 2, 60)); }},
    {"pyramid", [](Random& r) { return pyramid(r, true); }},
    {"fan", [](Random& r) { return pyramid(r, false); }},
    {"strip", strip},
    {"tiny", tiny},
    {"assembly", assembly},
    {"plate", [](Random& r) { return corpus::plate_with_holes(number_between(r, 1, 24), 2); }},
    {"ring of tori",
     [](Random& r) { return corpus::melted_tori(number_between(r, 2, 12), number_between(r, 16, 28)); }},
    {"terrain",
     [](Random& r) {
         return perforated(corpus::roughened(corpus::terrain(20), 0.2, r()), r, number_between(r, 0, 60));
     }},
};

// More than the usual number of surfaces can be asked for by hand.
uint32_t surfaces(uint32_t usual) {
    const char* wanted = std::getenv("GIM_MANIFOLDS");
    return wanted != nullptr ? static_cast<uint32_t>(std::strtoul(wanted, nullptr, 10)) : usual;
}

void expect_surface(const Result<Encoded>& encoded, const std::string& name) {
    ASSERT_TRUE(encoded.ok()) << name << ": " << encoded.error().message;
    expect_topology(encoded.value(), 0, name);
}

void encode_all(const EncodeOptions& options, uint32_t count) {
    for (uint32_t seed = 0; seed < count; ++seed) {
        const Kind& kind = kKinds[seed % std::size(kKinds)];
        Random random(seed);
        const TriangleMesh mesh = kind.make(random);
        if (mesh.triangles.empty()) continue;
        const std::string name = kind.name + std::string(", seed ") + std::to_string(seed) + ", " +
                                 std::to_string(mesh.triangles.size()) + " triangles";
        expect_surface(encode(mesh, options), name);
    }
}

TEST(CleanManifolds, AreCodedAsSquares) {
    EncodeOptions options;
    options.side = 33;
    options.rate.kind = RateTarget::Kind::kLossless;
    encode_all(options, surfaces(std::size(kKinds)));
}

TEST(CleanManifolds, AreCodedAsCharts) {
    EncodeOptions options;
    options.layout = Layout::kMcgim;
    options.samples = 65 * 65;
    options.rate.kind = RateTarget::Kind::kLossless;
    if (surfaces(0) == 0) GTEST_SKIP() << "takes minutes for each surface; set GIM_MANIFOLDS to their number";
    encode_all(options, surfaces(0));
}

}  // namespace
}  // namespace gim
