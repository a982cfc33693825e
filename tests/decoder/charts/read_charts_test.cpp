// Files of charts through the C interface.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "decoder/charts/chart_decoder.h"
#include "format/checksum.h"
#include "format/container.h"
#include "gim/decoder.hpp"
#include "tests/decoder/vector_file.h"
#include "tests/format/raw_chart_table.h"

namespace gim {
namespace {

using Bytes = std::vector<uint8_t>;

using test::vector_file;

// Every vector of charts.
std::vector<std::string> chart_vectors() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(std::string(GIM_SOURCE_DIR) + "/spec/vectors/valid")) {
        const std::string name = entry.path().stem();
        if (entry.path().extension() == ".gim" && name.find("charts-") == 0) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

// One level, decoded as mesh and as grid into memory of exactly the announced size.
struct Level {
    gim_status status = GIM_OK;
    gim_info info{};
    gim_level_info level{};
    std::vector<float> grid, grid_normals, grid_texcoords, mesh, normals, texcoords;
    std::vector<uint32_t> grid_triangles, triangles;
};
Level decode(const Bytes& file, uint32_t l, uint8_t scratch_value = 0xA5) {
    Level out;
    out.status = gim_read_info(file.data(), file.size(), nullptr, &out.info);
    if (out.status == GIM_OK) out.status = gim_read_level_info(&out.info, file.data(), file.size(), 0, l, &out.level);
    if (out.status != GIM_OK) return out;
    const size_t samples = size_t{out.level.width} * out.level.height, vertices = out.level.vertex_count;
    out.grid.resize(samples * 3);
    out.grid_normals.resize(samples * 3);
    out.grid_texcoords.resize(samples * 2);
    out.mesh.resize(vertices * 3);
    out.normals.resize(vertices * 3);
    out.texcoords.resize(vertices * 2);
    out.triangles.resize(size_t{out.level.triangle_count} * 3);
    out.grid_triangles.resize(out.triangles.size());
    Scratch scratch(out.level.scratch_size);
    EXPECT_EQ(scratch.size(), out.level.scratch_size);
    std::memset(scratch.data(), scratch_value, out.level.scratch_size);
    out.status =
        gim_decode_grid(&out.info, file.data(), file.size(), 0, l, out.grid.data(), out.grid_normals.data(),
                        out.grid_texcoords.data(), out.grid_triangles.data(), scratch.data(), out.level.scratch_size);
    if (out.status != GIM_OK) return out;
    std::memset(scratch.data(), scratch_value, out.level.scratch_size);
    out.status = gim_decode_mesh(&out.info, file.data(), file.size(), 0, l, out.mesh.data(), out.normals.data(),
                                 out.texcoords.data(), out.triangles.data(), scratch.data(), out.level.scratch_size);
    return out;
}
template <class F>
void for_each_level(const F& f) {
    for (const std::string& name : chart_vectors()) {
        const Bytes file = vector_file(name);
        uint32_t coarsest = 0;
        for (uint32_t l = 0; l <= coarsest; ++l) {
            SCOPED_TRACE(name + " level " + std::to_string(l));
            const Level level = decode(file, l);
            ASSERT_EQ(level.status, GIM_OK);
            coarsest = level.level.coarsest_level;
            f(name, file, level, l);
        }
    }
}

bool is_undefined(const float* position) { return std::isnan(position[0]); }

TEST(ReadCharts, VectorsOfAllKindsAreThere) {
    std::set<uint32_t> codings, levels;
    for_each_level([&](const std::string&, const Bytes&, const Level& f, uint32_t l) {
        codings.insert(f.info.coding);
        levels.insert(l);
        EXPECT_EQ(f.info.layout, static_cast<uint32_t>(GIM_LAYOUT_MCGIM));
        EXPECT_EQ(f.info.image_count, 1u);
        EXPECT_EQ(f.level.side, 0u);
    });
    EXPECT_EQ(codings.size(), 2u);
    EXPECT_GE(levels.size(), 3u);
}

TEST(ReadCharts, MeshAndGridAreTheSameSurface) {
    for_each_level([](const std::string&, const Bytes&, const Level& f, uint32_t) {
        std::map<uint32_t, uint32_t> first_sample;
        for (size_t i = 0; i < f.triangles.size(); ++i) {
            const uint32_t v = f.triangles[i], s = f.grid_triangles[i];
            ASSERT_LT(v, f.level.vertex_count);
            ASSERT_LT(s, f.level.width * f.level.height);
            for (size_t k = 0; k < 3; ++k) {
                ASSERT_EQ(f.mesh[v * 3 + k], f.grid[s * 3 + k]);
                ASSERT_EQ(f.normals[v * 3 + k], f.grid_normals[s * 3 + k]);
            }
            const auto [it, is_first] = first_sample.try_emplace(v, s);
            it->second = std::min(it->second, s);
        }
        EXPECT_EQ(first_sample.size(), f.level.vertex_count);
        for (const auto& [v, s] : first_sample) {
            const float length = std::hypot(f.normals[v * 3], f.normals[v * 3 + 1], f.normals[v * 3 + 2]);
            EXPECT_TRUE(length == 0 || std::abs(length - 1) < 1e-5f);
        }
    });
}

TEST(ReadCharts, UndefinedSamplesAreNotANumberAndInNoTriangle) {
    for_each_level([](const std::string&, const Bytes&, const Level& f, uint32_t) {
        std::vector<uint8_t> used(f.grid.size() / 3, 0);
        for (const uint32_t s : f.grid_triangles) used[s] = 1;
        size_t undefined = 0;
        for (size_t s = 0; s < used.size(); ++s) {
            const float* p = &f.grid[s * 3];
            ASSERT_EQ(std::isnan(p[0]), std::isnan(p[1]));
            ASSERT_EQ(std::isnan(p[0]), std::isnan(p[2]));
            if (!is_undefined(p)) continue;
            ++undefined;
            EXPECT_EQ(used[s], 0);
            for (size_t k = 0; k < 3; ++k) EXPECT_EQ(f.grid_normals[s * 3 + k], 0.0f);
            for (size_t k = 0; k < 2; ++k) EXPECT_EQ(f.grid_texcoords[s * 2 + k], 0.0f);
        }
        EXPECT_LT(undefined, used.size());
        for (const float x : f.mesh) EXPECT_TRUE(std::isfinite(x));
    });
}

TEST(ReadCharts, SurfacesAreOrientedManifoldsWithTheClaimedCounts) {
    for_each_level([](const std::string& name, const Bytes&, const Level& f, uint32_t) {
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
        const bool is_open = name.find("open") != std::string::npos || name.find("ladder") != std::string::npos;
        EXPECT_EQ(open > 0, is_open);
        const auto count = [](size_t n) { return static_cast<int64_t>(n); };
        const int64_t euler = count(f.level.vertex_count) - count((edges.size() + open) / 2) + f.level.triangle_count;
        const bool is_torus = name.find("torus") != std::string::npos || name.find("encoder") != std::string::npos;
        EXPECT_EQ(euler, is_open ? 1 : is_torus ? 0 : 2);
    });
}

TEST(ReadCharts, TextureCoordinatesAreThePlacesInTheRectangleAtEveryLevel) {
    for (const std::string& name : chart_vectors()) {
        const Bytes file = vector_file(name);
        const Level finest = decode(file, 0);
        ASSERT_EQ(finest.status, GIM_OK);
        const auto width = static_cast<float>(finest.level.width - 1),
                   height = static_cast<float>(finest.level.height - 1);
        for (uint32_t s = 0; s < finest.grid.size() / 3; ++s) {
            if (is_undefined(&finest.grid[size_t{s} * 3])) continue;
            ASSERT_EQ(finest.grid_texcoords[size_t{s} * 2], static_cast<float>(s % finest.level.width) / width);
            ASSERT_EQ(finest.grid_texcoords[size_t{s} * 2 + 1], static_cast<float>(s / finest.level.width) / height);
        }
        // A coarse sample lies where a fine one does, or just outside of its chart: the surface is near it.
        for (uint32_t l = 1; l <= finest.level.coarsest_level; ++l) {
            const Level f = decode(file, l);
            ASSERT_EQ(f.status, GIM_OK);
            for (uint32_t v = 0; v < f.level.vertex_count; ++v) {
                const float column = f.texcoords[size_t{v} * 2] * width, row = f.texcoords[size_t{v} * 2 + 1] * height;
                EXPECT_NEAR(column, std::round(column), 1e-3) << name;
                EXPECT_NEAR(row, std::round(row), 1e-3) << name;
            }
        }
    }
}

TEST(ReadCharts, ContentsOfScratchDoNotMatter) {
    for_each_level([](const std::string&, const Bytes& file, const Level& f, uint32_t l) {
        for (const uint8_t value : {uint8_t{0}, uint8_t{0xFF}}) {
            const Level other = decode(file, l, value);
            ASSERT_EQ(other.status, GIM_OK);
            EXPECT_EQ(test::to_bytes(other.grid), test::to_bytes(f.grid));
            EXPECT_EQ(other.grid_triangles, f.grid_triangles);
            EXPECT_EQ(other.mesh, f.mesh);
            EXPECT_EQ(other.normals, f.normals);
            EXPECT_EQ(other.texcoords, f.texcoords);
            EXPECT_EQ(other.triangles, f.triangles);
        }
    });
}

TEST(ReadCharts, ALevelNeedsItsPrefixAndNoMore) {
    for_each_level([](const std::string&, const Bytes& file, const Level& f, uint32_t l) {
        Bytes prefix(file.begin(), file.begin() + static_cast<ptrdiff_t>(f.level.prefix_size));
        const Level same = decode(prefix, l);
        ASSERT_EQ(same.status, GIM_OK);
        EXPECT_EQ(same.mesh, f.mesh);
        EXPECT_EQ(same.triangles, f.triangles);
        prefix.pop_back();
        EXPECT_EQ(decode(prefix, l).status, GIM_NEED_MORE_INPUT);
        // Damage behind the prefix does not matter.
        Bytes damaged = file;
        if (f.level.prefix_size < file.size()) {
            damaged.back() ^= 1;
            EXPECT_EQ(decode(damaged, l).status, GIM_OK);
        }
    });
}

// 2^26 samples, the default limit, need less than 4 GiB.
TEST(ReadCharts, MemoryIsBoundedByTheSamplesOfAllBoxes) {
    constexpr uint64_t kModels = 16384, kBytesPerSample = 60;  // models: whatever the size
    for (const char* name : {"charts-torus-lossy", "charts-torus-lossless", "charts-encoder-lossy"}) {
        const Bytes file = vector_file(name);
        gim_info info;
        ASSERT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
        Header header;
        ASSERT_EQ(parse_header(file, {}, &header), Status::kOk);
        ChartLevelShape shape;
        ASSERT_EQ(open_charts(header, file, {}, 0, &shape), Status::kOk);
        gim_level_info level;
        ASSERT_EQ(gim_read_level_info(&info, file.data(), file.size(), 0, 0, &level), GIM_OK);
        EXPECT_LT(level.scratch_size, kModels + kBytesPerSample * shape.samples) << name;
    }
}

TEST(ReadCharts, CallersMistakesAreTold) {
    const Bytes file = vector_file("charts-pillow-lossy");
    const Level f = decode(file, 0);
    ASSERT_EQ(f.status, GIM_OK);
    std::vector<float> x(f.grid.size());
    Scratch scratch(f.level.scratch_size);
    auto* memory = static_cast<std::byte*>(scratch.data());
    const uint8_t* b = file.data();
    const size_t n = file.size(), s = f.level.scratch_size;
    for (const bool mesh : {false, true}) {
        const auto decode_to = [&](uint32_t image, uint32_t level, float* out, void* room, size_t room_size) {
            return mesh ? gim_decode_mesh(&f.info, b, n, image, level, out, nullptr, nullptr, nullptr, room, room_size)
                        : gim_decode_positions(&f.info, b, n, image, level, out, room, room_size);
        };
        EXPECT_EQ(decode_to(0, 0, x.data(), memory, s), GIM_OK);
        EXPECT_EQ(decode_to(1, 0, x.data(), memory, s), GIM_BAD_ARGUMENT);
        EXPECT_EQ(decode_to(0, f.level.coarsest_level + 1, x.data(), memory, s), GIM_NO_SUCH_LEVEL);
        EXPECT_EQ(decode_to(0, 0, nullptr, memory, s), GIM_BAD_ARGUMENT);
        EXPECT_EQ(decode_to(0, 0, x.data(), nullptr, s), GIM_BAD_ARGUMENT);
        EXPECT_EQ(decode_to(0, 0, x.data(), memory + 4, s), GIM_BAD_ARGUMENT);
        EXPECT_EQ(decode_to(0, 0, x.data(), memory, s - 1), GIM_SCRATCH_TOO_SMALL);
    }
    gim_level_info level;
    EXPECT_EQ(gim_read_level_info(&f.info, b, n, 1, 0, &level), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_level_info(&f.info, b, n, 0, 99, &level), GIM_NO_SUCH_LEVEL);
    EXPECT_EQ(gim_read_level_info(&f.info, b, n, 0, 0, nullptr), GIM_BAD_ARGUMENT);
    uint32_t paths = 0, class_of = 0;
    EXPECT_EQ(gim_read_seams(&f.info, b, n, 0, 0, nullptr, &paths), GIM_OK);
    EXPECT_EQ(paths, 6u);
    EXPECT_EQ(gim_read_seams(&f.info, b, n, 0, 0, nullptr, nullptr), GIM_OK);
    EXPECT_EQ(gim_read_seams(&f.info, b, n, 0, 0, &class_of, &paths), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_seams(&f.info, b, n, 1, 0, nullptr, &paths), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_seams(&f.info, b, n, 0, 99, nullptr, &paths), GIM_NO_SUCH_LEVEL);
    gim_plane_info plane;
    EXPECT_EQ(gim_read_plane_info(&f.info, b, n, 0, GIM_PLANE_NORMALS, 0, &plane), GIM_NO_SUCH_PLANE);
    EXPECT_EQ(gim_read_plane_info(&f.info, b, n, 1, GIM_PLANE_NORMALS, 0, &plane), GIM_BAD_ARGUMENT);
}

TEST(ReadCharts, LosslessSamplesAreWholeUnits) {
    for (const std::string& name : chart_vectors()) {
        if (name.find("lossless") == std::string::npos) continue;
        const Level f = decode(vector_file(name), 0);
        ASSERT_EQ(f.status, GIM_OK);
        for (size_t i = 0; i < f.mesh.size(); ++i) {
            const double unit = (double{f.mesh[i]} - f.info.origin[i % 3]) / double{f.info.step};
            EXPECT_NEAR(unit, std::round(unit), 1e-2) << name;
        }
    }
}

// ---- files that claim too much --------------------------------------------------------------------------------------

Bytes with_table(const Bytes& file, const test::RawTable& table, uint32_t width, uint32_t height) {
    Header header;
    EXPECT_EQ(parse_header(file, {}, &header), Status::kOk);
    header.width = width;
    header.height = height;
    header.level_count = static_cast<uint32_t>(table.sizes.size());
    std::vector<Chunk> chunks(1 + header.level_count);
    const Bytes payload = test::table_bytes(table, width, height);
    for (Chunk& chunk : chunks) {
        chunk.type = ChunkType::kLevel;
        chunk.crc = crc16({});
    }
    chunks[0].type = ChunkType::kSeams;
    chunks[0].size = payload.size();
    chunks[0].crc = crc16(payload);
    Bytes out = serialize_header(header, chunks);
    out.insert(out.end(), payload.begin(), payload.end());
    return out;
}

TEST(ReadCharts, ACoarseGridThatIsMostlyEmptyCountsAgainstTheLimit) {
    // Wide boxes beside tall ones: at level 1 each begins a shelf of its own.
    test::RawTable table;
    table.box_bits = 15;
    table.sizes = {{4, 2}, {4, 2}};
    for (int i = 0; i < 3; ++i) {
        table.charts.push_back({32767, 3, 0, 0, 0, "-"});
        table.charts.push_back({3, 8191, 0, 0, 0, "-"});
    }
    const Bytes file = with_table(vector_file("charts-open-lossless"), table, 100, 100);
    gim_info info;
    gim_level_info level;
    ASSERT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
    EXPECT_EQ(gim_read_level_info(&info, file.data(), file.size(), 0, 0, &level), GIM_OK);
    EXPECT_EQ(gim_read_level_info(&info, file.data(), file.size(), 0, 1, &level), GIM_LIMIT_EXCEEDED);
    const gim_limits generous = {uint64_t{1} << 30, 1, 1 << 16};
    ASSERT_EQ(gim_read_info(file.data(), file.size(), &generous, &info), GIM_OK);
    ASSERT_EQ(gim_read_level_info(&info, file.data(), file.size(), 0, 1, &level), GIM_OK);
    EXPECT_EQ(level.width, 16384u);
    EXPECT_EQ(level.height, 3 * (2 + 1 + 4096 + 1) - 1u);
}

TEST(ReadCharts, TheSmallestLimitsThatAFileNeedsAreItsOwnSize) {
    const Bytes file = vector_file("charts-pillow-lossless");
    gim_info info;
    gim_level_info level;
    ASSERT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
    ASSERT_EQ(gim_read_level_info(&info, file.data(), file.size(), 0, 0, &level), GIM_OK);
    const uint64_t boxes = 13 * 13 + 15 * 15, samples = std::max(boxes, info.sample_count);
    const uint32_t side = std::max(level.width, level.height);
    gim_limits limits = {samples, 1, side};
    ASSERT_EQ(gim_read_info(file.data(), file.size(), &limits, &info), GIM_OK);
    EXPECT_EQ(gim_read_level_info(&info, file.data(), file.size(), 0, 0, &level), GIM_OK);
    limits.max_side = side - 1;
    EXPECT_EQ(gim_read_info(file.data(), file.size(), &limits, &info), GIM_LIMIT_EXCEEDED);
    limits = {boxes - 1, 1, side};
    gim_status status = gim_read_info(file.data(), file.size(), &limits, &info);
    if (status == GIM_OK) status = gim_read_level_info(&info, file.data(), file.size(), 0, 0, &level);
    EXPECT_EQ(status, GIM_LIMIT_EXCEEDED);
}

}  // namespace
}  // namespace gim
