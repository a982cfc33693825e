// Files of tiles through the C interface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "format/checksum.h"
#include "format/container.h"
#include "format/tile_atlas.h"
#include "gim/decoder.hpp"
#include "tests/decoder/vectors.h"

namespace gim {
namespace {

using Bytes = std::vector<uint8_t>;

std::map<std::string, Bytes> tile_vectors() {
    std::map<std::string, Bytes> files;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(GIM_SOURCE_DIR) + "/spec/vectors/valid")) {
        const std::string name = entry.path().stem();
        if (entry.path().extension() == ".gim" && name.find("tiles-") == 0)
            files[name] = test::read_bytes(entry.path());
    }
    return files;
}

struct Level {
    gim_status status = GIM_OK;
    DecoderLevel size;
    std::vector<float> grid, grid_normals, grid_texcoords, mesh, normals, texcoords;
    std::vector<uint32_t> grid_triangles, triangles;
};
Level decode(const Bytes& file, uint32_t l) {
    Level out;
    Decoder decoder;
    out.status = decoder.open(file);
    if (out.status == GIM_OK) out.status = decoder.read_level(0, l, &out.size);
    if (out.status != GIM_OK) return out;
    const size_t samples = size_t{out.size.width} * out.size.height, vertices = out.size.vertex_count;
    out.grid.resize(samples * 3);
    out.grid_normals.resize(samples * 3);
    out.grid_texcoords.resize(samples * 2);
    out.mesh.resize(vertices * 3);
    out.normals.resize(vertices * 3);
    out.texcoords.resize(vertices * 2);
    out.triangles.resize(size_t{out.size.triangle_count} * 3);
    out.grid_triangles.resize(out.triangles.size());
    out.status = decoder.grid(out.size, {out.grid, out.grid_normals, out.grid_texcoords, out.grid_triangles});
    if (out.status != GIM_OK) return out;
    out.status = decoder.mesh(out.size, {out.mesh, out.normals, out.texcoords, out.triangles});
    return out;
}

template <class F>
void for_each_level(const F& f) {
    const auto files = tile_vectors();
    EXPECT_GE(files.size(), 10u);
    for (const auto& [name, file] : files) {
        uint32_t coarsest = 0;
        for (uint32_t l = 0; l <= coarsest; ++l) {
            SCOPED_TRACE(name + " level " + std::to_string(l));
            const Level level = decode(file, l);
            ASSERT_EQ(level.status, GIM_OK);
            coarsest = level.size.coarsest_level;
            f(name, file, level);
        }
    }
}

TEST(ReadTiles, MeshAndGridAreTheSameSurface) {
    for_each_level([](const std::string&, const Bytes&, const Level& f) {
        std::set<uint32_t> used;
        for (size_t i = 0; i < f.triangles.size(); ++i) {
            const uint32_t v = f.triangles[i], s = f.grid_triangles[i];
            ASSERT_LT(v, f.size.vertex_count);
            ASSERT_LT(s, f.size.width * f.size.height);
            used.insert(v);
            for (size_t k = 0; k < 3; ++k) {
                ASSERT_EQ(f.mesh[v * 3 + k], f.grid[s * 3 + k]);
                ASSERT_EQ(f.normals[v * 3 + k], f.grid_normals[s * 3 + k]);
            }
        }
        EXPECT_EQ(used.size(), f.size.vertex_count);
    });
}

TEST(ReadTiles, SurfacesAreOrientedManifolds) {
    for_each_level([](const std::string& name, const Bytes&, const Level& f) {
        std::map<std::pair<uint32_t, uint32_t>, int> edges;
        for (size_t t = 0; t < f.triangles.size(); t += 3) {
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t a = f.triangles[t + k], b = f.triangles[t + (k + 1) % 3];
                ASSERT_NE(a, b);
                ASSERT_EQ(++edges[std::pair(a, b)], 1) << "an edge twice the same way";
            }
        }
        size_t open = 0;
        for (const auto& [edge, count] : edges) open += !edges.contains({edge.second, edge.first});
        const bool is_open = name.find("tiles-one") != std::string::npos || name.find("strip") != std::string::npos ||
                             name.find("components") != std::string::npos;
        EXPECT_EQ(open > 0, is_open);
    });
}

TEST(ReadTiles, UnusedSlotsAreUndefined) {
    for_each_level([](const std::string&, const Bytes&, const Level& f) {
        std::vector<bool> used(f.grid.size() / 3);
        for (const uint32_t s : f.grid_triangles) used[s] = true;
        for (size_t s = 0; s < used.size(); ++s) {
            ASSERT_EQ(std::isnan(f.grid[3 * s]), !used[s]);
            if (used[s]) continue;
            for (size_t k = 0; k < 3; ++k) EXPECT_EQ(f.grid_normals[3 * s + k], 0.0f);
            for (size_t k = 0; k < 2; ++k) EXPECT_EQ(f.grid_texcoords[2 * s + k], 0.0f);
        }
    });
}

TEST(ReadTiles, ALevelNeedsItsPrefixAndNoMore) {
    for_each_level([](const std::string&, const Bytes& file, const Level& f) {
        Bytes prefix(file.begin(), file.begin() + static_cast<ptrdiff_t>(f.size.prefix_size));
        const Level same = decode(prefix, f.size.level);
        ASSERT_EQ(same.status, GIM_OK);
        EXPECT_EQ(same.mesh, f.mesh);
        prefix.pop_back();
        EXPECT_EQ(decode(prefix, f.size.level).status, GIM_NEED_MORE_INPUT);
    });
}

// Makes a file of changed payloads, with their checksums.
Bytes with_payloads(const Bytes& file, const std::function<void(std::vector<Bytes>&)>& change) {
    Header header;
    EXPECT_EQ(parse_header(file, {}, &header), Status::kOk);
    std::vector<Chunk> chunks;
    std::vector<Bytes> payloads;
    ChunkWalk walk(header);
    Chunk chunk;
    for (uint64_t offset = 0; walk.next(&chunk, &offset);) {
        const auto begin = file.begin() + static_cast<ptrdiff_t>(offset);
        chunks.push_back(chunk);
        payloads.emplace_back(begin, begin + static_cast<ptrdiff_t>(chunk.size));
    }
    change(payloads);
    for (size_t i = 0; i < chunks.size(); ++i) {
        chunks[i].size = payloads[i].size();
        chunks[i].crc = crc16(payloads[i]);
    }
    Bytes out = serialize_header(header, chunks);
    for (const Bytes& p : payloads) out.insert(out.end(), p.begin(), p.end());
    return out;
}

TEST(ReadTiles, SignedDamageIsRefusedOrDecodesToASurface) {
    for (const auto& [name, file] : tile_vectors()) {
        SCOPED_TRACE(name);
        size_t chunks = 0, refused = 0, decoded = 0;
        (void)with_payloads(file, [&](std::vector<Bytes>& p) { chunks = p.size(); });
        for (size_t c = 0; c < chunks; ++c) {
            size_t size = 0;
            (void)with_payloads(file, [&](std::vector<Bytes>& p) { size = p[c].size(); });
            for (size_t i = 0; i < std::min<size_t>(size, 40); ++i) {
                for (const int bit : {0, 3, 7}) {
                    const Bytes damaged = with_payloads(
                        file, [&](std::vector<Bytes>& p) { p[c][i] = static_cast<uint8_t>(p[c][i] ^ 1u << bit); });
                    const Level level = decode(damaged, 0);
                    if (level.status != GIM_OK) {
                        EXPECT_EQ(level.status, GIM_MALFORMED);
                        ++refused;
                        continue;
                    }
                    ++decoded;
                    for (const float x : level.mesh) ASSERT_TRUE(std::isfinite(x));
                    for (const float x : level.normals) ASSERT_TRUE(std::isfinite(x));
                }
            }
        }
        EXPECT_GT(refused + decoded, 0u);
    }
}

TEST(ReadTiles, CallersMistakesAreTold) {
    const Bytes file = tile_vectors().at("tiles-cube-lossy");
    gim_info info;
    ASSERT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
    EXPECT_EQ(info.layout, static_cast<uint32_t>(GIM_LAYOUT_TILES));
    EXPECT_EQ(info.image_count, 1u);
    gim_level_info level;
    const uint8_t* b = file.data();
    const size_t n = file.size();
    ASSERT_EQ(gim_read_level_info(&info, b, n, 0, 0, &level), GIM_OK);
    EXPECT_EQ(level.side, 0u);
    EXPECT_EQ(gim_read_level_info(&info, b, n, 1, 0, &level), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_level_info(&info, b, n, 0, 99, &level), GIM_NO_SUCH_LEVEL);
    std::vector<float> x(3 * size_t{level.width} * level.height);
    Scratch scratch(level.scratch_size);
    const auto decode_to = [&](uint32_t l, float* out, void* room, size_t size) {
        return gim_decode_positions(&info, b, n, 0, l, out, room, size);
    };
    EXPECT_EQ(decode_to(0, x.data(), scratch.data(), level.scratch_size), GIM_OK);
    EXPECT_EQ(decode_to(99, x.data(), scratch.data(), level.scratch_size), GIM_NO_SUCH_LEVEL);
    EXPECT_EQ(decode_to(0, nullptr, scratch.data(), level.scratch_size), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode_to(0, x.data(), nullptr, level.scratch_size), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode_to(0, x.data(), scratch.data(), level.scratch_size - 1), GIM_SCRATCH_TOO_SMALL);
    uint32_t paths = 0, class_of = 0;
    EXPECT_EQ(gim_read_seams(&info, b, n, 0, 0, nullptr, &paths), GIM_OK);
    EXPECT_EQ(paths, 12u);
    EXPECT_EQ(gim_read_seams(&info, b, n, 0, 0, &class_of, &paths), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_seams(&info, b, n, 0, 99, nullptr, &paths), GIM_NO_SUCH_LEVEL);
}

TEST(ReadTiles, TheSmallestLimitsThatAFileNeedsAreItsAtlas) {
    const Bytes file = tile_vectors().at("tiles-cube-lossy");
    gim_info info;
    const uint64_t samples = uint64_t{27} * 18;  // 3 x 2 slots of 9 x 9
    gim_limits limits = {samples, 1, 27};
    EXPECT_EQ(gim_read_info(file.data(), file.size(), &limits, &info), GIM_OK);
    EXPECT_EQ(info.sample_count, samples);
    limits.max_side = 26;
    EXPECT_EQ(gim_read_info(file.data(), file.size(), &limits, &info), GIM_LIMIT_EXCEEDED);
    limits = {samples - 1, 1, 27};
    EXPECT_EQ(gim_read_info(file.data(), file.size(), &limits, &info), GIM_LIMIT_EXCEEDED);
}

TEST(TileAtlas, SlotsFillARectangleNearASquare) {
    for (uint32_t tiles = 1; tiles <= 700; ++tiles) {
        const TileAtlas atlas(tiles, 4);
        const uint32_t columns = atlas.width() / 5, rows = atlas.height() / 5;
        EXPECT_GE(columns * rows, tiles);
        EXPECT_LT((rows - 1) * columns, tiles);
        EXPECT_LE(columns, 2 * rows + 1);
        EXPECT_LE(rows, columns);
        EXPECT_EQ(atlas.column(tiles - 1) / 5, (tiles - 1) % columns);
        EXPECT_EQ(atlas.row(tiles - 1) / 5, rows - 1);
    }
    EXPECT_EQ(TileAtlas(63, 32).width(), 9u * 33);  // 9 x 7: nothing is wasted
}

}  // namespace
}  // namespace gim
