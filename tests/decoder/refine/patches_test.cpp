// Patches cover the image, and neighbours put the same vertices on the border that they share.
#include <gtest/gtest.h>

#include "tests/decoder/refine/refinable.h"
#include "tests/random_numbers.h"

namespace gim {
namespace {

using namespace gim::test;

// The vertex at each sample of the image. A mesh that is refined to the end tells.
struct SampleMap {
    uint32_t columns, slot;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> vertex_at;  // by row and column

    SampleMap(const std::string& name, bool is_square) {
        Refinable r(name);
        gim_level_info level;
        EXPECT_EQ(gim_read_level_info(&r.info, r.file.data(), r.file.size(), 0, 0, &level), GIM_OK);
        slot = is_square ? r.shape.intervals : r.shape.intervals + 1;
        columns = level.width / slot;
        gim_rule all{};
        all.object_error = 1e-12f;
        all.need = [](void*, uint32_t, const float*, float, float) { return 2.0f; };
        EXPECT_EQ(gim_refine(r.mesh, &all, 0, nullptr), GIM_OK);
        for (uint32_t h = 0; h < 3 * r.count(); ++h) {
            const gim_half_edge edge = r.half_edge(h);
            vertex_at[{edge.tile / columns * slot + edge.start[0], edge.tile % columns * slot + edge.start[1]}] =
                edge.vertex;
        }
    }
};

std::vector<gim_patch> patches_of(const Refinable& r) {
    std::vector<gim_patch> patches(2 * size_t{r.count()});
    uint32_t count = 0;
    EXPECT_EQ(gim_read_patches(r.mesh, patches.data(), static_cast<uint32_t>(patches.size()), &count), GIM_OK);
    patches.resize(count);
    return patches;
}

// Samples along the borders of a patch, counter-clockwise, each border from its start up to its end.
std::vector<std::vector<std::pair<uint32_t, uint32_t>>> borders_of(const gim_patch& p) {
    const uint32_t size = 1u << p.side;
    const std::pair<uint32_t, uint32_t> corners[5] = {{p.row, p.column},
                                                      {p.row, p.column + size},
                                                      {p.row + size, p.column + size},
                                                      {p.row + size, p.column},
                                                      {p.row, p.column}};
    std::vector<std::vector<std::pair<uint32_t, uint32_t>>> borders;
    for (uint32_t k = 0; k < 4; ++k) {
        const uint32_t edges = 1u << (p.inside + (p.finer >> k & 1));
        const auto between_corners = [&](uint32_t a, uint32_t b, uint32_t i) {
            return (a * (edges - i) + b * i) / edges;
        };
        std::vector<std::pair<uint32_t, uint32_t>> border;
        for (uint32_t i = 0; i <= edges; ++i)
            border.emplace_back(between_corners(corners[k].first, corners[k + 1].first, i),
                                between_corners(corners[k].second, corners[k + 1].second, i));
        borders.push_back(border);
    }
    return borders;
}

void expect_closed(const Refinable& r, const SampleMap& samples, uint64_t boundary_intervals) {
    const std::vector<gim_patch> patches = patches_of(r);
    uint64_t area = 0, open = 0;
    std::map<std::pair<uint32_t, uint32_t>, uint64_t> edges;  // from vertex to vertex: length in intervals
    std::set<uint32_t> covered;
    for (const gim_patch& p : patches) {
        ASSERT_LE(p.inside, p.side);
        area += uint64_t{1} << (2 * p.side);
        for (uint32_t k = 0; k < 4; ++k) {
            ASSERT_LE(p.inside + (p.finer >> k & 1), p.side);
        }
        for (const auto& border : borders_of(p)) {
            for (size_t i = 0; i + 1 < border.size(); ++i) {
                const uint32_t a = samples.vertex_at.at(border[i]), b = samples.vertex_at.at(border[i + 1]);
                const uint64_t length = (uint64_t{1} << p.side) / (border.size() - 1);
                ASSERT_TRUE(edges.emplace(std::pair{a, b}, length).second) << "an edge twice in one direction";
            }
        }
        const uint32_t step = 1u << (p.side - p.inside);
        for (uint32_t row = 0; row <= 1u << p.side; row += step) {
            for (uint32_t column = 0; column <= 1u << p.side; column += step)
                covered.insert(samples.vertex_at.at({p.row + row, p.column + column}));
        }
    }
    ASSERT_EQ(area, uint64_t{r.shape.tile_count} * r.shape.intervals * r.shape.intervals);
    for (const auto& [edge, length] : edges) {
        if (!edges.count({edge.second, edge.first})) open += length;
    }
    ASSERT_EQ(open, boundary_intervals);
    for (const Face& face : r.faces()) {
        for (const uint32_t v : face) ASSERT_EQ(covered.count(v), 1u);
    }
}

TEST(Patches, NeighboursShareTheVerticesOfTheirBorders) {
    Random random(5);
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Refinable r(name);
        const SampleMap samples(name, std::string(name).rfind("tiles", 0) != 0);
        const uint64_t boundary = static_cast<uint64_t>(topology_of(r).boundary_edges) * r.shape.intervals;
        expect_closed(r, samples, boundary);
        for (int i = 0; i < 300; ++i) {
            const uint32_t f = number_between(random, 0, r.count() - 1);
            if (i % 3 == 2)
                (void)gim_weld(r.mesh, r.face(f)[2]);
            else
                (void)gim_split(r.mesh, f);
            if (i % 10 == 0) expect_closed(r, samples, boundary);
            ASSERT_FALSE(HasFatalFailure()) << "operation " << i;
        }
    }
}

TEST(Patches, ATileThatIsAsFineEverywhereIsOnePatch) {
    for (const char* name : {"tiles-cube-lossy", "sphere-33-lossy"}) {
        SCOPED_TRACE(name);
        Refinable r(name);
        EXPECT_EQ(patches_of(r).size(), r.shape.tile_count);
        gim_rule all{};
        all.need = [](void*, uint32_t, const float*, float, float) { return 2.0f; };
        ASSERT_EQ(gim_refine(r.mesh, &all, 0, nullptr), GIM_OK);
        const std::vector<gim_patch> patches = patches_of(r);
        EXPECT_EQ(patches.size(), r.shape.tile_count);
        for (const gim_patch& p : patches) {
            EXPECT_EQ(1u << p.side, r.shape.intervals);
            EXPECT_EQ(p.inside, p.side);
            EXPECT_EQ(p.finer, 0);
        }
    }
}

TEST(Patches, ACallThatHasNoRoomTellsHowManyThereAre) {
    Refinable r("tiles-cube-lossy");
    uint32_t count = 0;
    EXPECT_EQ(gim_read_patches(r.mesh, nullptr, 0, &count), GIM_SCRATCH_TOO_SMALL);
    EXPECT_EQ(count, r.shape.tile_count);
    EXPECT_EQ(gim_read_patches(r.mesh, nullptr, 1, &count), GIM_BAD_ARGUMENT);
}

}  // namespace
}  // namespace gim
