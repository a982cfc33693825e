#include "encoder/squares/boundary_map.h"

#include <gtest/gtest.h>

#include <numeric>

#include "encoder/squares/cut.h"
#include "format/seam.h"
#include "tests/encoder/stage_meshes.h"

namespace gim {
namespace {

struct Laid {
    NamedMesh input;
    SquareBoundary boundary;
};

std::vector<Laid> laid_out(const BoundaryMapOptions& options) {
    std::vector<Laid> result;
    for (NamedMesh& m : connected_meshes()) {
        const Topology topology = build_topology(m.mesh);
        const CutEdges cut = straighten_cut(m.mesh, topology, initial_cut(m.mesh, topology, 0));
        auto boundary = map_boundary(open_mesh(m.mesh, topology, cut).value(), options);
        EXPECT_TRUE(boundary.ok()) << m.name;
        if (boundary.ok()) result.push_back({std::move(m), std::move(boundary.value())});
    }
    return result;
}

// The part of the boundary loop that each cut-path has on the surface.
std::vector<double> shares_of(const OpenedMesh& opened) {
    std::vector<double> lengths(opened.paths.size(), 0.0);
    for (size_t i = 0, k = 0; i < opened.loop.size(); ++i) {
        while (k + 1 < opened.paths.size() && opened.paths[k + 1].first <= i) ++k;
        const Vec3 &a = opened.mesh.positions[opened.loop[i]],
                   &b = opened.mesh.positions[opened.loop[(i + 1) % opened.loop.size()]];
        lengths[k] += (b - a).norm();
    }
    const double all = std::accumulate(lengths.begin(), lengths.end(), 0.0);
    for (double& length : lengths) length /= all;
    return lengths;
}

TEST(BoundaryMap, PathsFillTheRingAndMatesAreEquallyLong) {
    for (const Laid& l : laid_out({})) {
        const Sideband& sideband = l.boundary.sideband;
        uint32_t total = 0;
        for (const CutPath& path : sideband.paths) {
            total += path.length;
            if (path.mate != kNoMate) {
                EXPECT_EQ(sideband.paths[static_cast<size_t>(path.mate)].length, path.length) << l.input.name;
            }
        }
        EXPECT_EQ(total, 4 * (sideband.node_side - 1)) << l.input.name;
    }
}

TEST(BoundaryMap, EveryCornerOfTheSquareIsAVertex) {
    for (const Laid& l : laid_out({65, 17})) {
        for (const double corner : {0.0, 64.0, 128.0, 192.0}) {
            EXPECT_EQ(std::count(l.boundary.ring.begin(), l.boundary.ring.end(), corner), 1)
                << l.input.name << " " << corner;
        }
    }
}

TEST(BoundaryMap, RingPositionsRiseOnceAround) {
    for (const Laid& l : laid_out({})) {
        const std::vector<double>& ring = l.boundary.ring;
        int falls = 0;
        for (size_t i = 0; i < ring.size(); ++i) {
            ASSERT_NE(ring[i], ring[(i + 1) % ring.size()]) << l.input.name;
            falls += ring[(i + 1) % ring.size()] < ring[i];
        }
        EXPECT_EQ(falls, 1) << l.input.name;
    }
}

TEST(BoundaryMap, NoInteriorEdgeLiesAlongASide) {
    for (const Laid& l : laid_out({})) {
        const Mesh& mesh = l.boundary.opened.mesh;
        const Topology topology = build_topology(mesh);
        for (uint32_t h = 0; h < topology.twin.size(); ++h) {
            if (topology.twin[h] == kNone) continue;
            EXPECT_EQ(l.boundary.sides[from(mesh, h)] & l.boundary.sides[to(mesh, h)], 0) << l.input.name;
        }
        EXPECT_EQ(euler_characteristic(mesh), 1) << l.input.name;
    }
}

TEST(BoundaryMap, TheNodeGridIsClosedAndFineEnoughForEveryPathToHaveAboutItsShare) {
    for (const double most_excess : {0.02, 0.1, 0.5}) {
        for (const Laid& l : laid_out({257, 5, most_excess})) {
            const Sideband& sideband = l.boundary.sideband;
            SeamTable seams;
            ASSERT_EQ(build_seam_table(sideband, &seams), Status::kOk);
            EXPECT_TRUE(level_is_closed(seams, sideband.node_side)) << l.input.name;
            const std::vector<double> shares = shares_of(l.boundary.opened);
            double excess = 0;
            for (size_t k = 0; k < shares.size(); ++k) {
                excess += std::max(0.0, double(sideband.paths[k].length) / (4 * (sideband.node_side - 1)) - shares[k]);
            }
            if (shares.size() > 2) {
                EXPECT_LE(excess, most_excess + 1e-3) << l.input.name;
            }
        }
    }
}

TEST(BoundaryMap, EveryPathHasTheLeastThatIsAskedFor) {
    for (const uint32_t least : {1u, 2u, 3u}) {
        bool is_tight = false;
        for (const Laid& l : laid_out({257, 5, 1, least})) {
            for (const CutPath& path : l.boundary.sideband.paths) {
                EXPECT_GE(path.length, least) << l.input.name;
                is_tight = is_tight || path.length == least;
            }
        }
        EXPECT_TRUE(is_tight) << least;
    }
}

TEST(BoundaryMap, NoLeafOfTheCutLiesOnACorner) {
    for (const Laid& l : laid_out({})) {
        const Sideband& sideband = l.boundary.sideband;
        uint32_t at = sideband.start;
        for (size_t k = 0; k < sideband.paths.size(); ++k) {
            at += sideband.paths[k].length;
            if (sideband.paths[k].mate == (k + 1) % sideband.paths.size()) {
                EXPECT_NE(at % (sideband.node_side - 1), 0u) << l.input.name;
            }
        }
    }
}

TEST(BoundaryMap, TooManyPathsForTheImageIsAClearError) {
    const Mesh mesh = clean(corpus::plate_with_holes(3, 4)).value().mesh;
    const Topology topology = build_topology(mesh);
    const CutEdges cut = initial_cut(mesh, topology, 0);
    const OpenedMesh opened = open_mesh(mesh, topology, cut).value();
    const auto boundary = map_boundary(opened, {5, 5});
    ASSERT_FALSE(boundary.ok());
    EXPECT_NE(boundary.error().message.find("too many"), std::string::npos);
    EXPECT_FALSE(check_room(opened, {5, 5}).ok());
    EXPECT_TRUE(check_room(opened, {65, 5}).ok());
}

TEST(RingPoint, WalksTheSquareCounterClockwise) {
    EXPECT_EQ(ring_point(0.0, 5), Vec2(0, 0));
    EXPECT_EQ(ring_point(4.0, 5), Vec2(1, 0));
    EXPECT_EQ(ring_point(8.0, 5), Vec2(1, 1));
    EXPECT_EQ(ring_point(12.0, 5), Vec2(0, 1));
    EXPECT_EQ(ring_point(14.0, 5), Vec2(0, 0.5));
}

}  // namespace
}  // namespace gim
