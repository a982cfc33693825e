// A vector of spec/vectors with a mesh over it that can be refined, and what must hold for every such mesh.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <new>
#include <set>
#include <string>
#include <vector>

#include "gim/refine.h"
#include "tests/decoder/vectors.h"

namespace gim::test {

// Memory for the C interface.
class Block {
  public:
    explicit Block(size_t size) : size_(size), bytes_(::operator new (size, std::align_val_t{64})) {}
    ~Block() { ::operator delete (bytes_, std::align_val_t{64}); }
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    void* get() const { return bytes_; }
    size_t size() const { return size_; }

  private:
    size_t size_;
    void* bytes_;
};

using Face = std::array<uint32_t, 3>;

// Begins with its lowest vertex, so that equal triangles compare equal.
inline Face turned(Face face) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

struct Refinable {
    std::string name;
    uint32_t level;
    std::vector<uint8_t> file;
    gim_info info{};
    gim_domain_info shape{};
    std::vector<float> positions;
    std::unique_ptr<Block> domain_memory, mesh_memory;
    const gim_domain* domain = nullptr;
    gim_refined* mesh = nullptr;

    // most_triangles: 0 for as many as the finest mesh has.
    explicit Refinable(const std::string& vector, uint32_t most_triangles = 0, uint32_t at_level = 0)
        : name(vector), level(at_level) {
        file = read_bytes(std::filesystem::path(GIM_SOURCE_DIR) / "spec/vectors/valid" / (vector + ".gim"));
        EXPECT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
        gim_level_info level_info;
        EXPECT_EQ(gim_read_level_info(&info, file.data(), file.size(), 0, level, &level_info), GIM_OK);
        positions.resize(3 * size_t{level_info.vertex_count});
        Block scratch(level_info.scratch_size);
        EXPECT_EQ(gim_decode_mesh(&info, file.data(), file.size(), 0, level, positions.data(), nullptr, nullptr,
                                  nullptr, scratch.get(), scratch.size()),
                  GIM_OK);
        EXPECT_EQ(gim_read_domain_info(&info, file.data(), file.size(), 0, level, &shape), GIM_OK);
        EXPECT_EQ(shape.vertex_count, level_info.vertex_count);
        domain_memory = std::make_unique<Block>(shape.domain_size);
        Block domain_scratch(shape.scratch_size);
        EXPECT_EQ(gim_open_domain(&info, file.data(), file.size(), 0, level, positions.data(), domain_memory->get(),
                                  domain_memory->size(), domain_scratch.get(), domain_scratch.size(), &domain),
                  GIM_OK);
        begin(most_triangles > 0 ? most_triangles : static_cast<uint32_t>(shape.most_triangles));
    }
    void begin(uint32_t most_triangles) {
        mesh_memory = std::make_unique<Block>(gim_refined_size(domain, most_triangles));
        ASSERT_EQ(gim_begin_refined(domain, most_triangles, mesh_memory->get(), mesh_memory->size(), &mesh), GIM_OK);
    }

    uint32_t count() const {
        uint32_t triangles = 0;
        (void)gim_refined_triangles(mesh, &triangles);
        return triangles;
    }
    Face face(uint32_t triangle) const {
        const uint32_t* v = gim_refined_triangles(mesh, nullptr) + 3 * size_t{triangle};
        return {v[0], v[1], v[2]};
    }
    std::multiset<Face> faces() const {
        std::multiset<Face> all;
        for (uint32_t f = 0; f < count(); ++f) all.insert(turned(face(f)));
        return all;
    }
    gim_half_edge half_edge(uint32_t h) const {
        gim_half_edge read{};
        EXPECT_EQ(gim_read_half_edge(mesh, h, &read), GIM_OK);
        return read;
    }
    uint32_t level_of(uint32_t triangle) const { return half_edge(3 * triangle + 2).level; }
};

// What holds for every triangle and its neighbours.
inline void expect_sound(const Refinable& r, uint32_t triangle) {
    for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t h = 3 * triangle + i;
        const gim_half_edge edge = r.half_edge(h), next = r.half_edge(3 * triangle + (i + 1) % 3);
        ASSERT_LT(edge.vertex, r.shape.vertex_count);
        ASSERT_NE(edge.vertex, next.vertex) << "an edge without length";
        ASSERT_EQ(edge.end[0], next.start[0]);
        ASSERT_EQ(edge.end[1], next.start[1]);
        if (edge.mate == GIM_NOTHING) {
            // Only sides of tiles are boundaries.
            const auto n = static_cast<uint16_t>(r.shape.intervals);
            const bool along_row = edge.start[0] == edge.end[0] && (edge.start[0] == 0 || edge.start[0] == n);
            const bool along_column = edge.start[1] == edge.end[1] && (edge.start[1] == 0 || edge.start[1] == n);
            ASSERT_TRUE(along_row || along_column);
            continue;
        }
        const gim_half_edge mate = r.half_edge(edge.mate);
        ASSERT_EQ(mate.mate, h);
        ASSERT_EQ(mate.vertex, next.vertex);
        ASSERT_EQ(r.half_edge(edge.mate % 3 == 2 ? edge.mate - 2 : edge.mate + 1).vertex, edge.vertex);
        const uint32_t one = r.level_of(triangle), other = r.level_of(edge.mate / 3);
        ASSERT_LE(std::max(one, other) - std::min(one, other), 1u);
    }
}

struct Topology {
    int64_t euler = 0, boundary_edges = 0;
    uint32_t most_uses = 0;  // of one pair of vertices by triangles
};
inline Topology topology_of(const Refinable& r) {
    Topology t;
    std::set<uint32_t> vertices;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> uses;
    int64_t edges = 0;
    for (uint32_t h = 0; h < 3 * r.count(); ++h) {
        const gim_half_edge edge = r.half_edge(h);
        vertices.insert(edge.vertex);
        const uint32_t to = r.half_edge(h % 3 == 2 ? h - 2 : h + 1).vertex;
        t.most_uses = std::max(t.most_uses, ++uses[std::minmax(edge.vertex, to)]);
        edges += edge.mate == GIM_NOTHING || h < edge.mate;
        t.boundary_edges += edge.mate == GIM_NOTHING;
    }
    t.euler = static_cast<int64_t>(vertices.size()) - edges + r.count();
    return t;
}

inline void expect_sound(const Refinable& r) {
    for (uint32_t f = 0; f < r.count(); ++f) {
        expect_sound(r, f);
        if (::testing::Test::HasFatalFailure()) return;
    }
}

// Follows a mesh by its changes alone.
struct Follower {
    std::set<uint32_t> vertices;
    std::vector<Face> triangles;

    // Returns the triangles that changed.
    std::vector<uint32_t> follow(Refinable& r) {
        gim_changes c;
        gim_take_changes(r.mesh, &c);
        EXPECT_EQ(c.triangles_before, triangles.size());
        for (uint32_t i = 0; i < c.added_count; ++i) EXPECT_TRUE(vertices.insert(c.added[i]).second);
        for (uint32_t i = 0; i < c.removed_count; ++i) EXPECT_EQ(vertices.erase(c.removed[i]), 1u);
        triangles.resize(c.triangle_count);
        for (uint32_t i = 0; i < c.changed_count; ++i) triangles.at(c.triangles[i]) = r.face(c.triangles[i]);
        return {c.triangles, c.triangles + c.changed_count};
    }
    void expect_same(const Refinable& r) const {
        ASSERT_EQ(triangles.size(), r.count());
        std::set<uint32_t> used;
        for (uint32_t f = 0; f < r.count(); ++f) {
            ASSERT_EQ(triangles[f], r.face(f)) << f;
            used.insert(triangles[f].begin(), triangles[f].end());
        }
        ASSERT_EQ(used, vertices);
    }
};

// Tiles of every kind, and squares: closed, with handles, with boundaries.
inline constexpr const char* kRefinables[] = {
    "tiles-cube-lossy",         "tiles-genus-2-sharp-lossy", "tiles-torus-lossy", "tiles-two-components-lossy",
    "tiles-strip-lossy-coarse", "tiles-one-lossy",           "sphere-33-lossy",   "torus-33-lossy",
    "tube-33-lossy-coarse",
};

}  // namespace gim::test
