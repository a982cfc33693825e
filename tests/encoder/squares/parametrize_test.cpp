#include "encoder/squares/parametrize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "encoder/squares/boundary_map.h"
#include "encoder/squares/cut.h"
#include "encoder/squares/make_square.h"
#include "encoder/squares/sample_square.h"
#include "encoder/surface/defects.h"
#include "encoder/surface/stretch.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

SquareBoundary laid_out(const Mesh& mesh, uint32_t side) {
    const Topology topology = build_topology(mesh);
    const CutEdges cut = straighten_cut(mesh, topology, initial_cut(mesh, topology, 0));
    return map_boundary(open_mesh(mesh, topology, cut).value(), {side, 17}).value();
}

TEST(Parametrize, NoTriangleIsFlippedOnAnySurface) {
    for (const NamedMesh& m : connected_meshes()) {
        const SquareBoundary boundary = laid_out(m.mesh, 257);
        const auto uv = parametrize(boundary.opened.mesh, boundary.sides, boundary_uv(boundary, 257), {});
        ASSERT_TRUE(uv.ok()) << m.name << ": " << uv.error().message;
        EXPECT_EQ(count_flipped(boundary.opened.mesh, uv.value()), 0u) << m.name;
        // Together the triangles cover the square exactly once.
        double area = 0;
        for (const Triangle& t : boundary.opened.mesh.triangles) {
            area += 0.5 * twice_signed_area(uv.value()[t[0]], uv.value()[t[1]], uv.value()[t[2]]);
        }
        EXPECT_NEAR(area, 1, 1e-9) << m.name;
    }
}

// Triangles within triangles: Tutte's map shrinks each by a factor, and soon has no digits left.
Mesh nested_triangles(uint32_t count) {
    Mesh mesh;
    for (uint32_t k = 0; k < count; ++k) {
        for (int i = 0; i < 3; ++i) {
            const double angle = 2.0943951023931953 * i + 0.3 * k, radius = 1.0 - double(k) / count;
            mesh.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.2 * (k % 2)});
        }
        for (uint32_t i = 0; k > 0 && i < 3; ++i) {
            const uint32_t a = 3 * (k - 1) + i, b = 3 * (k - 1) + (i + 1) % 3;
            mesh.triangles.push_back({a, b, a + 3});
            mesh.triangles.push_back({b, b + 3, a + 3});
        }
    }
    const uint32_t last = 3 * (count - 1);
    mesh.triangles.push_back({last, last + 1, last + 2});
    return mesh;
}

TEST(Parametrize, NoTriangleIsFlippedWhereMostOfThemEncloseTheOthers) {
    for (const uint32_t count : {30, 100, 200}) {
        const SquareBoundary boundary = laid_out(nested_triangles(count), 65);
        const auto uv = parametrize(boundary.opened.mesh, boundary.sides, boundary_uv(boundary, 65), {});
        ASSERT_TRUE(uv.ok()) << count << ": " << uv.error().message;
        EXPECT_EQ(count_flipped(boundary.opened.mesh, uv.value()), 0u) << count;
    }
}

TEST(Parametrize, FlatSquareComesBackAlmostIsometric) {
    const Mesh mesh = clean(corpus::terrain(40)).value().mesh;
    Mesh flat = mesh;
    for (Vec3& p : flat.positions) p.z() = 0;
    const SquareBoundary boundary = laid_out(flat, 257);
    const auto uv = parametrize(boundary.opened.mesh, boundary.sides, boundary_uv(boundary, 257), {});
    ASSERT_TRUE(uv.ok());
    EXPECT_GT(stretch_efficiency(boundary.opened.mesh, uv.value(), 1), 0.93);  // its corners need not meet the square's
}

TEST(Parametrize, BoundaryStaysWhereItWasPut) {
    const Mesh mesh = clean(corpus::torus(30, 15, 1, 0.4)).value().mesh;
    const SquareBoundary boundary = laid_out(mesh, 257);
    const std::vector<Vec2> start = boundary_uv(boundary, 257);
    const auto uv = parametrize(boundary.opened.mesh, boundary.sides, start, {});
    ASSERT_TRUE(uv.ok());
    for (const uint32_t v : boundary.opened.loop) EXPECT_EQ(uv.value()[v], start[v]);
}

// Per face: the larger singular value of the map from the square over the smaller one.
std::vector<double> anisotropies(const Mesh& mesh, const std::vector<Vec2>& uv) {
    std::vector<double> result;
    for (const Triangle& t : mesh.triangles) {
        const FaceMetric metric = face_metric(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], 0);
        const double area = 2 * metric.weight;
        if (!(area > 0)) continue;
        // The sum of the squared singular values over their product.
        const double ratio = 2 * stretch_energy(metric, uv[t[0]], uv[t[1]], uv[t[2]]) / area *
                             (0.5 * twice_signed_area(uv[t[0]], uv[t[1]], uv[t[2]])) / area;
        result.push_back(0.5 * (ratio + std::sqrt(std::max(0.0, ratio * ratio - 4))));
    }
    return result;
}

// A limbed body, cut open as the encoder does it.
SquareBoundary limbs_cut_open(uint32_t side) {
    const Mesh mesh = clean(corpus::limbed_blob(24)).value().mesh;
    EncodeOptions options;
    options.side = side;
    return cut_open(make_cuttable(mesh, options), options, {}).value().boundary;
}

TEST(Parametrize, SqueezeKeepsSamplesOnLongLimbsFromCrowdingInOneDirection) {
    const uint32_t side = 65;
    const SquareBoundary boundary = limbs_cut_open(side);
    const Mesh& disk = boundary.opened.mesh;
    std::vector<double> most, efficiency;
    for (const double squeeze : {0.0, 0.2, 1.0}) {
        ParametrizeOptions options;
        options.squeeze = squeeze;
        const auto uv = parametrize(disk, boundary.sides, boundary_uv(boundary, side), options);
        ASSERT_TRUE(uv.ok()) << uv.error().message;
        EXPECT_EQ(count_flipped(disk, uv.value()), 0u) << squeeze;
        std::vector<double> values = anisotropies(disk, uv.value());
        most.push_back(percentile(values, 0.99));
        efficiency.push_back(stretch_efficiency(disk, uv.value(), 1));
    }
    EXPECT_LT(most[1], 0.8 * most[0]);
    EXPECT_LT(most[2], 0.6 * most[0]);
    // Without a squeeze nothing but stretch counts.
    EXPECT_GT(efficiency[0], efficiency[1]);
    EXPECT_GT(efficiency[1], efficiency[2]);
}

TEST(Parametrize, SqueezeIsFreeUnlessAskedFor) {
    EXPECT_EQ(ParametrizeOptions{}.squeeze, 0);
    const Mesh mesh = clean(corpus::torus(30, 15, 1, 0.4)).value().mesh;
    const SquareBoundary boundary = laid_out(mesh, 65);
    const std::vector<Vec2> border = boundary_uv(boundary, 65);
    ParametrizeOptions free;
    free.squeeze = 1e-300;
    const auto with_none = parametrize(boundary.opened.mesh, boundary.sides, border, {}),
               with_next_to_none = parametrize(boundary.opened.mesh, boundary.sides, border, free);
    ASSERT_TRUE(with_none.ok() && with_next_to_none.ok());
    EXPECT_EQ(with_none.value(), with_next_to_none.value());
}

TEST(Parametrize, AMapperLeavesNothingBehindForItsNextMap) {
    const Mesh mesh = clean(corpus::torus(30, 15, 1, 0.4)).value().mesh;
    const SquareBoundary boundary = laid_out(mesh, 65);
    const std::vector<Vec2> border = boundary_uv(boundary, 65);
    const DiskMapper mapper(boundary.opened.mesh, boundary.sides, border);
    ParametrizeOptions other;
    other.squeeze = 0.5;
    const auto first = mapper.map({}), second = mapper.map(other), third = mapper.map({});
    ASSERT_TRUE(first.ok() && second.ok() && third.ok());
    EXPECT_EQ(first.value(), parametrize(boundary.opened.mesh, boundary.sides, border, {}).value());
    EXPECT_EQ(second.value(), parametrize(boundary.opened.mesh, boundary.sides, border, other).value());
    EXPECT_EQ(third.value(), first.value());
    EXPECT_NE(second.value(), first.value());
}

TEST(Sample, EveryGridPointIsOnTheSurfaceAndMatesAreBitEqual) {
    for (const NamedMesh& m : connected_meshes()) {
        const uint32_t side = 257;
        const SquareBoundary boundary = laid_out(m.mesh, side);
        const auto uv = parametrize(boundary.opened.mesh, boundary.sides, boundary_uv(boundary, side), {});
        ASSERT_TRUE(uv.ok()) << m.name;
        for (const SurfacePoint& p : locate_samples(boundary.opened.mesh, uv.value(), side)) {
            ASSERT_NE(p.triangle, kNone) << m.name;
            for (const double w : p.barycentric) EXPECT_GT(w, -1e-6) << m.name;
        }
        const SquareImage image = sample_surface(boundary, uv.value(), side).value();
        const auto ring = [&](uint32_t p) {
            const Vec2 at = ring_point(p % (4 * (side - 1)), side) * (side - 1);
            return image.at(static_cast<uint32_t>(at.y()), static_cast<uint32_t>(at.x()));
        };
        const uint32_t scale = (side - 1) / (image.sideband.node_side - 1);
        std::vector<uint32_t> begins;
        uint32_t begin = image.sideband.start * scale;
        for (const CutPath& path : image.sideband.paths) begins.push_back(begin), begin += path.length * scale;
        for (size_t k = 0; k < begins.size(); ++k) {
            const CutPath& path = image.sideband.paths[k];
            if (path.mate == kNoMate) continue;
            const uint32_t mate_begin = begins[static_cast<size_t>(path.mate)], length = path.length * scale;
            for (uint32_t t = 0; t <= length; ++t) {
                ASSERT_EQ(ring(begins[k] + t), ring(mate_begin + length - t)) << m.name << " path " << k;
            }
        }
    }
}

}  // namespace
}  // namespace gim
