// Displacements add details to a surface: the samples stay where they were, displaced, and meshes have no cracks.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/decoder/refine/refinable.h"

namespace gim {
namespace {

using namespace gim::test;

constexpr const char* kDisplaced[] = {"displaced-sphere-17", "tiles-genus-2-displaced"};

// A vector with the domain of its displacements. r.positions: of that domain.
struct Detailed {
    Refinable r;
    gim_plane_info plane{};
    std::vector<float> plain, displacements;

    explicit Detailed(const std::string& vector) : r(vector) {
        plain = r.positions;
        const gim_status read =
            gim_read_plane_info(&r.info, r.file.data(), r.file.size(), 0, GIM_PLANE_DISPLACEMENTS, 0, &plane);
        EXPECT_EQ(read, GIM_OK);
        displacements.resize(3 * size_t{plane.width} * plane.height);
        Block of_plane(plane.scratch_size);
        EXPECT_EQ(gim_decode_plane(&r.info, r.file.data(), r.file.size(), 0, GIM_PLANE_DISPLACEMENTS, 0,
                                   displacements.data(), of_plane.get(), of_plane.size()),
                  GIM_OK);
        EXPECT_EQ(gim_read_detailed_domain_info(&r.info, r.file.data(), r.file.size(), 0, 0, &r.shape), GIM_OK);
        r.positions.resize(3 * size_t{r.shape.vertex_count});
        r.domain_memory = std::make_unique<Block>(r.shape.domain_size);
        Block scratch(r.shape.scratch_size);
        EXPECT_EQ(open(scratch.get(), scratch.size()), GIM_OK);
        r.begin(static_cast<uint32_t>(r.shape.most_triangles));
    }
    gim_status open(void* scratch, size_t size) {
        return gim_open_detailed_domain(&r.info, r.file.data(), r.file.size(), 0, 0, plain.data(), displacements.data(),
                                        r.positions.data(), r.domain_memory->get(), r.domain_memory->size(), scratch,
                                        size, &r.domain);
    }
    void refine_all() {
        gim_rule rule{};
        rule.need = [](void*, uint32_t, const float*, float, float) { return 2.0f; };
        EXPECT_EQ(gim_refine(r.mesh, &rule, 0, nullptr), GIM_OK);
    }
};

TEST(Details, TheFinestMeshHasAllTexelsAndTheTopologyOfTheSurface) {
    for (const char* name : kDisplaced) {
        SCOPED_TRACE(name);
        Refinable plain(name);
        Detailed d(name);
        const Topology base = topology_of(d.r);
        EXPECT_EQ(base.euler, topology_of(plain).euler);
        d.refine_all();
        EXPECT_EQ(d.r.count(), d.r.shape.most_triangles);
        EXPECT_GT(d.r.count(), plain.shape.most_triangles);
        expect_sound(d.r);
        const Topology finest = topology_of(d.r);
        EXPECT_EQ(finest.euler, base.euler);
        std::set<uint32_t> used;
        for (uint32_t f = 0; f < d.r.count(); ++f) {
            for (const uint32_t v : d.r.face(f)) used.insert(v);
        }
        EXPECT_EQ(used.size(), d.r.shape.vertex_count);
    }
}

// Each sample of level 0 is displaced by the texel on it; each other one lies between its neighbours, and is displaced.
TEST(Details, SamplesAreDisplacedByTheirTexels) {
    for (const char* name : kDisplaced) {
        SCOPED_TRACE(name);
        Detailed d(name);
        const uint32_t parts = 1u << (name == kDisplaced[0] ? 1 : 2);
        gim_level_info level;
        ASSERT_EQ(gim_read_level_info(&d.r.info, d.r.file.data(), d.r.file.size(), 0, 0, &level), GIM_OK);
        ASSERT_EQ(d.plane.width, (level.width - 1) * parts + 1);
        std::vector<float> grid(3 * size_t{level.width} * level.height);
        Block scratch(level.scratch_size);
        ASSERT_EQ(gim_decode_grid(&d.r.info, d.r.file.data(), d.r.file.size(), 0, 0, grid.data(), nullptr, nullptr,
                                  nullptr, scratch.get(), scratch.size()),
                  GIM_OK);
        const bool is_square = d.r.info.layout == GIM_LAYOUT_GIM;
        const uint32_t slot = d.r.shape.intervals + !is_square, coarse_slot = d.r.shape.intervals / parts + !is_square;
        ASSERT_EQ(d.r.shape.width, is_square ? d.plane.width : level.width / coarse_slot * slot);
        std::vector<float> laid(3 * size_t{d.r.shape.width} * d.r.shape.height);
        gim_lay_out_samples(d.r.domain, d.r.positions.data(), 3, laid.data());
        uint32_t tested = 0;
        float largest = 0;
        for (uint32_t y = 0; y < d.r.shape.height; ++y) {
            for (uint32_t x = 0; x < d.r.shape.width; ++x) {
                const float* position = &laid[3 * (size_t{y} * d.r.shape.width + x)];
                if (std::isnan(position[0])) continue;
                const uint32_t row = y % slot, column = x % slot;
                const uint32_t first_row = y / slot * coarse_slot, first_column = x / slot * coarse_slot;
                const float s = static_cast<float>(row % parts) / static_cast<float>(parts);
                const float t = static_cast<float>(column % parts) / static_cast<float>(parts);
                const auto at = [&](uint32_t down, uint32_t right, size_t k) {
                    const size_t r = first_row + row / parts + (s > 0 ? down : 0);
                    const size_t c = first_column + column / parts + (t > 0 ? right : 0);
                    return grid[3 * (r * level.width + c) + k];
                };
                const size_t texel = (size_t{first_row} * parts + row) * d.plane.width + first_column * parts + column;
                for (size_t k = 0; k < 3; ++k) {
                    const float between = (1 - s) * ((1 - t) * at(0, 0, k) + t * at(0, 1, k)) +
                                          s * ((1 - t) * at(1, 0, k) + t * at(1, 1, k));
                    EXPECT_NEAR(position[k], between + d.displacements[3 * texel + k],
                                1e-4 * std::abs(position[k]) + 1e-4);
                    largest = std::max(largest, std::abs(d.displacements[3 * texel + k]));
                }
                ++tested;
            }
        }
        EXPECT_GE(tested, d.r.shape.vertex_count);
        EXPECT_GT(largest, 0.01f);
    }
}

TEST(Details, WhatCannotBeIsRefused) {
    Refinable without("tiles-cube-lossy");
    gim_domain_info shape;
    const auto read = [&](const Refinable& r, uint32_t image, uint32_t level) {
        return gim_read_detailed_domain_info(&r.info, r.file.data(), r.file.size(), image, level, &shape);
    };
    EXPECT_EQ(read(without, 0, 0), GIM_NO_SUCH_PLANE);
    Detailed d(kDisplaced[0]);
    EXPECT_EQ(read(d.r, 0, 1), GIM_OK);
    EXPECT_EQ(read(d.r, 0, 2), GIM_NO_SUCH_LEVEL);  // coarser than the samples
    EXPECT_EQ(read(d.r, 1, 0), GIM_BAD_ARGUMENT);
    Block scratch(d.r.shape.scratch_size);
    EXPECT_EQ(d.open(scratch.get(), d.r.shape.scratch_size - 1), GIM_SCRATCH_TOO_SMALL);
    EXPECT_EQ(d.open(nullptr, scratch.size()), GIM_BAD_ARGUMENT);
    EXPECT_EQ(d.open(scratch.get(), scratch.size()), GIM_OK);
}

// Where only one region is wanted, the mesh is fine there alone, and sound everywhere.
TEST(Details, OneRegionAloneIsFine) {
    for (const char* name : kDisplaced) {
        SCOPED_TRACE(name);
        Detailed d(name);
        gim_rule rule{};
        rule.object_error = 1e-6f;
        const float* middle = &d.r.positions[0];
        for (size_t k = 0; k < 3; ++k) rule.sphere[k] = middle[k];
        rule.sphere[3] = 1e-3f;
        ASSERT_EQ(gim_refine(d.r.mesh, &rule, 0, nullptr), GIM_OK);
        EXPECT_GT(d.r.count(), 2 * d.r.shape.tile_count);
        EXPECT_LT(d.r.count(), d.r.shape.most_triangles / 2);
        expect_sound(d.r);
    }
}

}  // namespace
}  // namespace gim
