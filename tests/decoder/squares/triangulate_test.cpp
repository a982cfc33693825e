#include "decoder/squares/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "format/seam.h"
#include "tests/format/random_sideband.h"

namespace gim {
namespace {

using test::Random;
using test::random_sideband;

struct Counts {
    int64_t euler = 0;
    uint32_t loops = 0;
};

// The topology of the schema: the polygon's classes, edges and one face. Boundary loops follow open paths.
Counts of_schema(const SeamTable& t) {
    Counts c;
    const uint32_t n = t.path_count;
    if (n == 0) return {1, 1};
    int64_t edges = 0;
    for (uint32_t i = 0; i < n; ++i) edges += t.mate[i] == kNoMate || i < t.mate[i];
    c.euler = int64_t{t.node_class_count} - edges + 1;
    std::vector<bool> seen(n);
    for (uint32_t i = 0; i < n; ++i) {
        if (t.mate[i] != kNoMate || seen[i]) continue;
        ++c.loops;
        // The next open path turns around the end node across glued paths.
        for (uint32_t p = i; !seen[p];) {
            seen[p] = true;
            p = (p + 1) % n;
            while (t.mate[p] != kNoMate) p = (t.mate[p] + 1u) % n;
        }
    }
    return c;
}

std::vector<float> random_samples(Random& random, uint32_t side, const std::vector<uint32_t>& class_of) {
    std::vector<float> x(size_t{side} * side * 3);
    for (float& v : x) v = random.unit();
    // Values are coarse now and then, so that diagonals tie.
    if (random.below(2) == 0) {
        for (float& v : x) v = static_cast<float>(static_cast<int>(v * 2.5f));
    }
    std::map<uint32_t, size_t> first;
    for (uint32_t k = 0; k < class_of.size(); ++k) {
        const GridPoint p = ring_point(side, k);
        const size_t at = (size_t{p.row} * side + p.column) * 3;
        const auto [it, is_new] = first.try_emplace(class_of[k], at);
        if (!is_new)
            std::copy_n(x.begin() + static_cast<ptrdiff_t>(it->second), 3, x.begin() + static_cast<ptrdiff_t>(at));
    }
    return x;
}

// Returns an empty text if the indexed mesh is a connected oriented 2-manifold with these counts.
std::string manifold_complaint(const std::vector<uint32_t>& triangles, uint32_t vertex_count, const Counts& expected) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> next_of;  // directed edge -> opposite vertex
    for (size_t f = 0; f < triangles.size(); f += 3) {
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t a = triangles[f + i], b = triangles[f + (i + 1) % 3], c = triangles[f + (i + 2) % 3];
            if (a >= vertex_count) return "index out of range";
            if (a == b) return "degenerate triangle";
            if (!next_of.emplace(std::pair(a, b), c).second) return "directed edge used twice";
        }
    }
    int64_t edges = 0, boundary = 0;
    std::map<uint32_t, uint32_t> boundary_next;
    for (const auto& [e, c] : next_of) {
        const bool twin = next_of.count({e.second, e.first}) > 0;
        edges += !twin || e.first < e.second;
        if (!twin) {
            ++boundary;
            if (!boundary_next.emplace(e.first, e.second).second) return "two boundary edges leave a vertex";
        }
    }
    // Each vertex's link is one path or one cycle, so a walk from one edge meets all its edges.
    std::vector<uint32_t> degree(vertex_count);
    std::vector<std::pair<uint32_t, uint32_t>> some(vertex_count);
    for (const auto& [e, c] : next_of) {
        ++degree[e.first];
        some[e.first] = e;
    }
    for (uint32_t v = 0; v < vertex_count; ++v) {
        if (degree[v] == 0) return "vertex without faces";
        // a: next neighbour counter-clockwise. Goes back to the start of a path first.
        const auto ccw = [&](uint32_t a) { return next_of.at({v, a}); };
        uint32_t start = some[v].second, count = 0;
        for (uint32_t steps = 0; steps <= degree[v]; ++steps) {
            const auto before = next_of.find({start, v});
            if (before == next_of.end()) break;  // boundary: the fan begins here
            start = before->second;
            if (start == some[v].second) break;
        }
        for (uint32_t a = start; next_of.count({v, a}); ++count) {
            a = ccw(a);
            if (a == start) {
                ++count;
                break;
            }
        }
        if (count != degree[v]) return "a vertex with two fans";
    }
    uint32_t loops = 0;
    std::set<uint32_t> seen;
    for (const auto& [a, b] : boundary_next) {
        if (seen.count(a)) continue;
        ++loops;
        for (uint32_t v = a; seen.insert(v).second;) v = boundary_next.at(v);
    }
    const int64_t euler = int64_t{vertex_count} - edges + static_cast<int64_t>(triangles.size() / 3);
    if (euler != expected.euler) return "Euler characteristic " + std::to_string(euler);
    if (loops != expected.loops) return std::to_string(loops) + " boundary loops";
    return {};
}

std::vector<uint32_t> triangles_of(const std::vector<float>& samples, const std::vector<uint32_t>& class_of,
                                   const VertexNumbers& numbers) {
    const size_t side = numbers.side;
    std::vector<float> rows(side * 6);
    std::vector<uint32_t> is_main(side - 1), triangles((side - 1) * (side - 1) * 6);
    triangulate(samples.data(), numbers.side, class_of.data(), numbers, {rows.data(), is_main.data()},
                triangles.data());
    return triangles;
}

std::string closed_mesh_complaint(Random& random, const SeamTable& table, uint32_t side) {
    std::vector<uint32_t> class_of(ring_length(side));
    ring_classes(table, side, class_of);
    const uint32_t count = *std::max_element(class_of.begin(), class_of.end()) + 1;
    if (count != ring_class_count(table, side)) return "wrong class count";
    const std::vector<float> samples = random_samples(random, side, class_of);
    const VertexNumbers numbers = {side, class_of.data(), count};
    return manifold_complaint(triangles_of(samples, class_of, numbers), numbers.vertex_count(), of_schema(table));
}

TEST(Triangulate, EveryClosedLevelOfRandomSchemasIsAManifoldOfItsTopology) {
    Random random(1);
    uint32_t closed = 0, refused = 0, tight = 0;
    for (uint32_t round = 0; round < 8000; ++round) {
        const uint32_t node_side = (2u << random.below(3)) + 1;  // 3, 5, 9
        const uint32_t room = ring_length(node_side);
        const bool nested = random.below(2) == 0;
        const uint32_t pairs = random.below(std::min(room / 2, round % 2 ? 4u : 16u) + 1);
        const uint32_t open = random.below(std::min(room - 2 * pairs, 6u) + 1);
        if (2 * pairs + open == 0 || (open == 0 && room % 2 != 0)) continue;
        const Sideband s = random_sideband(random, node_side, pairs, open, nested);
        SeamTable table;
        ASSERT_EQ(build_seam_table(s, &table), Status::kOk);
        for (uint32_t side = node_side; side <= 17; side = 2 * side - 1) {
            if (!level_is_closed(table, side)) {
                ++refused;
                continue;
            }
            ++closed;
            tight += side == node_side;
            ASSERT_EQ(closed_mesh_complaint(random, table, side), "") << "round " << round << " side " << side;
        }
    }
    EXPECT_GT(closed, 2000u);
    EXPECT_GT(refused, 500u);
    EXPECT_GT(tight, 200u);
}

// level_is_closed must not be much stricter than needed: a level that it refuses is no manifold for some positions.
TEST(Triangulate, RefusedLevelsAreNotManifoldForSomePositions) {
    Random random(2);
    uint32_t refused = 0, excused = 0;
    for (uint32_t round = 0; round < 3000; ++round) {
        const uint32_t pairs = 1 + random.below(5), open = random.below(3);
        const Sideband s = random_sideband(random, 9, pairs, open, random.below(2) == 0);
        SeamTable table;
        ASSERT_EQ(build_seam_table(s, &table), Status::kOk);
        if (level_is_closed(table, 9)) continue;
        ++refused;
        bool fails = false;
        for (int attempt = 0; attempt < 20 && !fails; ++attempt)
            fails = !closed_mesh_complaint(random, table, 9).empty();
        excused += !fails;
    }
    EXPECT_GT(refused, 500u);
    EXPECT_EQ(excused, 0u);
}

TEST(Triangulate, OpenSquareHasOneLoopAtEverySide) {
    Random random(3);
    SeamTable table;
    ASSERT_EQ(build_seam_table(Sideband{2, 0, {}}, &table), Status::kOk);
    for (const uint32_t side : {3u, 5u, 9u, 33u}) {
        ASSERT_TRUE(level_is_closed(table, side));
        EXPECT_EQ(closed_mesh_complaint(random, table, side), "") << side;
    }
}

TEST(Triangulate, LeafDoesNotDoubleAnEdge) {
    // Both cells beside the leaf would prefer the diagonals that lead from the two (equal) samples next to it.
    const Sideband s = {9, 4, {{1, 16}, {0, 16}}};
    SeamTable table;
    ASSERT_EQ(build_seam_table(s, &table), Status::kOk);
    ASSERT_TRUE(level_is_closed(table, 9));
    Random random(4);
    for (int i = 0; i < 200; ++i) ASSERT_EQ(closed_mesh_complaint(random, table, 9), "");
}

TEST(Triangulate, LeafOnACornerIsRefused) {
    const Sideband s = {9, 8, {{1, 16}, {0, 16}}};
    SeamTable table;
    ASSERT_EQ(build_seam_table(s, &table), Status::kOk);
    EXPECT_FALSE(level_is_closed(table, 9));
    EXPECT_FALSE(level_is_closed(table, 17));
}

TEST(Triangulate, InnerCellsTakeTheShorterDiagonalAndTheMainOneWhenEqual) {
    const uint32_t side = 9;
    SeamTable table;
    ASSERT_EQ(build_seam_table(Sideband{2, 0, {}}, &table), Status::kOk);
    std::vector<uint32_t> class_of(ring_length(side));
    ring_classes(table, side, class_of);
    std::vector<float> x;
    for (uint32_t r = 0; r < side; ++r)
        for (uint32_t c = 0; c < side; ++c) x.insert(x.end(), {static_cast<float>(c), static_cast<float>(r), 0.0f});
    const VertexNumbers numbers = {side, nullptr, 0};
    std::vector<uint32_t> triangles;
    const auto triangle_of = [&](uint32_t row, uint32_t column) {
        const size_t at = (size_t{row} * (side - 1) + column) * 6;
        return std::array<uint32_t, 3>{triangles[at], triangles[at + 1], triangles[at + 2]};
    };
    const uint32_t a = 3 * side + 3;  // cell (3, 3)
    triangles = triangles_of(x, class_of, numbers);
    EXPECT_EQ(triangle_of(3, 3), (std::array<uint32_t, 3>{a, a + 1, a + side + 1}));
    x[a * 3 + 2] = 0.5f;  // lengthens the main diagonal
    triangles = triangles_of(x, class_of, numbers);
    EXPECT_EQ(triangle_of(3, 3), (std::array<uint32_t, 3>{a, a + 1, a + side}));
}

TEST(SampleNormals, AreUnitPointOutwardsAndAreSharedAcrossTheCut) {
    // A flat square: +z. With a leaf pair, glued samples get one normal.
    const uint32_t side = 9;
    SeamTable table;
    ASSERT_EQ(build_seam_table(Sideband{9, 4, {{1, 16}, {0, 16}}}, &table), Status::kOk);
    std::vector<uint32_t> class_of(ring_length(side));
    ring_classes(table, side, class_of);
    const uint32_t count = ring_class_count(table, side);
    std::vector<float> x, normals(size_t{side} * side * 3), sums(size_t{count} * 3);
    Random random(5);
    for (uint32_t r = 0; r < side; ++r)
        for (uint32_t c = 0; c < side; ++c)
            x.insert(x.end(), {static_cast<float>(c), static_cast<float>(r), 0.2f * random.unit()});
    sample_normals(x.data(), side, class_of.data(), count, sums.data(), normals.data());
    for (size_t i = 0; i < normals.size(); i += 3) {
        const float* n = &normals[i];
        EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0f, 1e-5f);
        EXPECT_GT(n[2], 0.5f);
    }
    for (uint32_t k = 0; k < class_of.size(); ++k) {
        for (uint32_t l = 0; l < k; ++l) {
            if (class_of[k] != class_of[l]) continue;
            const GridPoint p = ring_point(side, k), q = ring_point(side, l);
            for (uint32_t i = 0; i < 3; ++i)
                EXPECT_EQ(normals[(p.row * side + p.column) * 3 + i], normals[(q.row * side + q.column) * 3 + i]);
        }
    }
}

}  // namespace
}  // namespace gim
