// Splits and welds: every mesh on the way is as watertight as the surface, and every operation can be undone.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/decoder/refine/refinable.h"
#include "tests/random_numbers.h"

namespace gim {
namespace {

using namespace gim::test;

// The middle vertex of a triangle that the last split made.
uint32_t added_vertex(Refinable& r) {
    gim_changes c;
    gim_take_changes(r.mesh, &c);
    return c.added_count == 1 ? c.added[0] : GIM_NOTHING;
}

void weld_all(Refinable& r) {
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t f = 0; f < r.count(); ++f) changed |= gim_weld(r.mesh, r.face(f)[2]) == GIM_OK;
    }
}

TEST(RefinedMesh, BeginsWithTwoTrianglesForEachTile) {
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Refinable r(name);
        EXPECT_EQ(r.count(), 2 * r.shape.tile_count);
        expect_sound(r);
        EXPECT_LE(topology_of(r).most_uses, 2u);
    }
}

TEST(RefinedMesh, TheFinestMeshHasAllVerticesAndTheTopologyOfTheBase) {
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Refinable r(name);
        const Topology base = topology_of(r);
        for (bool changed = true; changed;) {
            changed = false;
            for (uint32_t f = 0; f < r.count(); ++f) changed |= gim_split(r.mesh, f) == GIM_OK;
        }
        EXPECT_EQ(r.count(), r.shape.most_triangles);
        expect_sound(r);
        const Topology finest = topology_of(r);
        EXPECT_EQ(finest.euler, base.euler);
        EXPECT_EQ(finest.boundary_edges, base.boundary_edges * r.shape.intervals);
        EXPECT_LE(finest.most_uses, 2u);
        std::set<uint32_t> vertices;
        for (const Face& face : r.faces()) vertices.insert(face.begin(), face.end());
        EXPECT_EQ(vertices.size(), r.shape.vertex_count);
    }
}

// Samples of a vertex have the place that its half-edges tell.
TEST(RefinedMesh, PlacesInTilesAreThoseOfTheDecodedSamples) {
    Refinable r("tiles-cube-lossy");
    gim_rule all{};
    all.object_error = 1e-9f;
    ASSERT_EQ(gim_refine(r.mesh, &all, 0, nullptr), GIM_OK);
    gim_level_info level;
    ASSERT_EQ(gim_read_level_info(&r.info, r.file.data(), r.file.size(), 0, 0, &level), GIM_OK);
    std::vector<float> grid(3 * size_t{level.width} * level.height);
    Block scratch(level.scratch_size);
    ASSERT_EQ(
        gim_decode_positions(&r.info, r.file.data(), r.file.size(), 0, 0, grid.data(), scratch.get(), scratch.size()),
        GIM_OK);
    const uint32_t slot = r.shape.intervals + 1, columns = level.width / slot;
    for (uint32_t h = 0; h < 3 * r.count(); ++h) {
        const gim_half_edge edge = r.half_edge(h);
        const size_t row = edge.tile / columns * slot + edge.start[0],
                     column = edge.tile % columns * slot + edge.start[1];
        for (size_t k = 0; k < 3; ++k)
            ASSERT_EQ(grid[3 * (row * level.width + column) + k], r.positions[3 * size_t{edge.vertex} + k]);
    }
}

// The sanitizers take ten times as long.
#ifdef __SANITIZE_ADDRESS__
constexpr int kOperations = 5000;
#else
constexpr int kOperations = 100000;
#endif

TEST(RefinedMesh, RandomSplitsAndWeldsKeepEveryMeshSound) {
    Random random(1);
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Refinable r(name);
        const Topology base = topology_of(r);
        const std::multiset<Face> base_faces = r.faces();
        Follower follower;
        (void)follower.follow(r);
        for (int i = 0; i < kOperations; ++i) {
            // From mostly splits to mostly welds and back.
            const bool splits = between(random, 0, 1) < 0.5 + 0.45 * std::sin(i * 1e-3);
            const uint32_t f = number_between(random, 0, r.count() - 1);
            const gim_status done = splits ? gim_split(r.mesh, f) : gim_weld(r.mesh, r.face(f)[2]);
            if (done != GIM_OK) continue;
            const std::vector<uint32_t> changed = follower.follow(r);
            ASSERT_FALSE(HasFatalFailure()) << "operation " << i;
            for (const uint32_t k : changed) {
                expect_sound(r, k);
                ASSERT_FALSE(HasFatalFailure()) << "operation " << i;
            }
            if (i % 1000 != 0) continue;
            expect_sound(r);
            follower.expect_same(r);
            ASSERT_FALSE(HasFatalFailure()) << "operation " << i;
            ASSERT_EQ(topology_of(r).euler, base.euler) << "operation " << i;
        }
        weld_all(r);
        EXPECT_EQ(r.faces(), base_faces);
    }
}

TEST(RefinedMesh, AWeldUndoesASplit) {
    Random random(2);
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Refinable r(name);
        uint32_t undone = 0;
        for (int i = 0; i < 400; ++i) {
            (void)added_vertex(r);
            const std::multiset<Face> before = r.faces();
            if (gim_split(r.mesh, number_between(random, 0, r.count() - 1)) != GIM_OK) continue;
            const uint32_t vertex = added_vertex(r);
            if (vertex == GIM_NOTHING) continue;  // it forced others
            ASSERT_EQ(gim_weld(r.mesh, vertex), GIM_OK);
            ASSERT_EQ(r.faces(), before);
            ++undone;
            (void)gim_split(r.mesh, number_between(random, 0, r.count() - 1));
        }
        EXPECT_GT(undone, r.shape.intervals > 2 ? 100u : 1u);
    }
}

TEST(RefinedMesh, AMeshWithoutRoomStaysAsItWas) {
    Refinable r("tiles-torus-lossy");
    r.begin(2 * r.shape.tile_count + 1);
    const std::multiset<Face> before = r.faces();
    EXPECT_EQ(gim_split(r.mesh, 0), GIM_SCRATCH_TOO_SMALL);
    EXPECT_EQ(r.faces(), before);
    expect_sound(r);
}

TEST(RefinedMesh, WrongArgumentsAreRefused) {
    Refinable r("tiles-torus-lossy");
    EXPECT_EQ(gim_split(r.mesh, r.count()), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_weld(r.mesh, r.face(0)[0]), GIM_BAD_ARGUMENT);  // of the base
    EXPECT_EQ(gim_weld(r.mesh, r.shape.vertex_count), GIM_BAD_ARGUMENT);
    gim_half_edge edge;
    EXPECT_EQ(gim_read_half_edge(r.mesh, 3 * r.count(), &edge), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_refined_size(r.domain, 2 * r.shape.tile_count - 1), 0u);
    gim_refined* mesh = nullptr;
    EXPECT_EQ(gim_begin_refined(r.domain, r.count(), r.mesh_memory->get(), 64, &mesh), GIM_SCRATCH_TOO_SMALL);
    EXPECT_EQ(gim_begin_refined(r.domain, 1, r.mesh_memory->get(), r.mesh_memory->size(), &mesh), GIM_BAD_ARGUMENT);
}

TEST(RefinedMesh, ChartsHaveNoTiles) {
    const auto file = read_bytes(std::filesystem::path(GIM_SOURCE_DIR) / "spec/vectors/valid/charts-torus-lossy.gim");
    gim_info info;
    ASSERT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
    gim_domain_info shape;
    EXPECT_EQ(gim_read_domain_info(&info, file.data(), file.size(), 0, 0, &shape), GIM_BAD_ARGUMENT);
}

// An error counts those of all later splits, so that a vertex is never needed more than those it needs.
TEST(RefinedMesh, WorthFallsFromSplitToSplit) {
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Refinable r(name);
        for (uint32_t f = 0; f < r.count(); ++f) {
            while (true) {
                const uint32_t parent = r.face(f)[2];
                (void)added_vertex(r);
                if (gim_split(r.mesh, f) != GIM_OK) break;
                const uint32_t child = r.face(f)[2];
                if (r.half_edge(3 * f + 2).level < 2) continue;
                float error[2], radius[2];
                gim_vertex_worth(r.domain, parent, &error[0], &radius[0]);
                gim_vertex_worth(r.domain, child, &error[1], &radius[1]);
                ASSERT_GE(error[0], error[1]);
                float square = 0;
                for (size_t k = 0; k < 3; ++k) {
                    const float d = r.positions[3 * size_t{parent} + k] - r.positions[3 * size_t{child} + k];
                    square += d * d;
                }
                ASSERT_GE(radius[0] * (1 + 1e-5f), std::sqrt(square) + radius[1]);
            }
        }
    }
}

}  // namespace
}  // namespace gim
