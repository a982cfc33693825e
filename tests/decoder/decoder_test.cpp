#include "gim/decoder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "format/ring.h"
#include "tests/decoder/vector_file.h"

namespace gim {
namespace {

using test::vector_file;

struct Opened {
    std::vector<uint8_t> bytes;
    gim_info info{};
    gim_level_info level{};

    explicit Opened(std::vector<uint8_t> file, uint32_t l = 0) : bytes(std::move(file)) {
        EXPECT_EQ(gim_read_info(bytes.data(), bytes.size(), nullptr, &info), GIM_OK);
        EXPECT_EQ(gim_read_level_info(&info, bytes.data(), bytes.size(), 0, l, &level), GIM_OK);
    }
};

TEST(Decoder, PositionsAreRelativeToABinary64Origin) {
    const Opened near(vector_file("sphere-17-lossless")), far(vector_file("wide-origin-lossless"));
    EXPECT_EQ(near.info.is_relative, 0u);
    EXPECT_EQ(far.info.is_relative, 1u);
    EXPECT_EQ(far.info.origin[0], 500000.1);
    EXPECT_EQ(far.info.origin[1], -4000000.3);
    EXPECT_EQ(far.info.origin[2], 0x1p100);
    const auto positions = [](const Opened& f) {
        std::vector<float> out(size_t{f.level.vertex_count} * 3);
        Scratch scratch(f.level.scratch_size);
        EXPECT_EQ(gim_decode_mesh(&f.info, f.bytes.data(), f.bytes.size(), 0, 0, out.data(), nullptr, nullptr, nullptr,
                                  scratch.data(), scratch.size()),
                  GIM_OK);
        return out;
    };
    const std::vector<float> relative = positions(far), absolute = positions(near);
    for (size_t i = 0; i < absolute.size(); ++i)
        EXPECT_EQ(static_cast<float>(near.info.origin[i % 3]) + relative[i], absolute[i]);
}

TEST(Decoder, MeshAndGridAreTheSameSurface) {
    for (const char* name : {"torus-33-lossy", "sphere-17-lossless", "tube-9-lossless", "schema-33-lossy-3"}) {
        const Opened f(vector_file(name));
        const size_t samples = size_t{f.level.side} * f.level.side;
        Scratch scratch(f.level.scratch_size);
        std::vector<float> grid(samples * 3), grid_normals(samples * 3), plain(samples * 3);
        std::vector<float> mesh(f.level.vertex_count * 3), normals(f.level.vertex_count * 3),
            uv(f.level.vertex_count * 2);
        std::vector<uint32_t> grid_triangles(f.level.triangle_count * 3), triangles(f.level.triangle_count * 3);
        ASSERT_EQ(gim_decode_grid(&f.info, f.bytes.data(), f.bytes.size(), 0, 0, grid.data(), grid_normals.data(),
                                  nullptr, grid_triangles.data(), scratch.data(), f.level.scratch_size),
                  GIM_OK);
        ASSERT_EQ(gim_decode_mesh(&f.info, f.bytes.data(), f.bytes.size(), 0, 0, mesh.data(), normals.data(), uv.data(),
                                  triangles.data(), scratch.data(), f.level.scratch_size),
                  GIM_OK);
        ASSERT_EQ(gim_decode_positions(&f.info, f.bytes.data(), f.bytes.size(), 0, 0, plain.data(), scratch.data(),
                                       f.level.scratch_size),
                  GIM_OK);
        EXPECT_EQ(plain, grid);
        std::map<uint32_t, uint32_t> sample_of;
        for (size_t i = 0; i < triangles.size(); ++i) {
            const uint32_t v = triangles[i], s = grid_triangles[i];
            ASSERT_LT(v, f.level.vertex_count);
            for (uint32_t k = 0; k < 3; ++k) {
                ASSERT_EQ(mesh[v * 3 + k], grid[s * 3 + k]) << name;
                ASSERT_EQ(normals[v * 3 + k], grid_normals[s * 3 + k]) << name;
            }
            const auto [it, first] = sample_of.try_emplace(v, s);
            it->second = std::min(it->second, s);
        }
        EXPECT_EQ(sample_of.size(), f.level.vertex_count);
        for (uint32_t v = 0; v < f.level.vertex_count; ++v) {
            const float length = std::hypot(normals[v * 3], normals[v * 3 + 1], normals[v * 3 + 2]);
            EXPECT_TRUE(length == 0 || std::abs(length - 1) < 1e-5f);
            EXPECT_TRUE(uv[v * 2] >= 0 && uv[v * 2] <= 1 && uv[v * 2 + 1] >= 0 && uv[v * 2 + 1] <= 1);
        }
    }
}

TEST(Decoder, GluedSamplesAreBitEqualAtEveryLevel) {
    for (const char* name : {"torus-33-lossy", "sphere-33-lossy", "schema-33-lossy-2"}) {
        const Opened whole(vector_file(name));
        for (uint32_t l = 0; l <= whole.level.coarsest_level; ++l) {
            const Opened f(whole.bytes, l);
            const uint32_t side = f.level.side;
            std::vector<float> x(size_t{side} * side * 3);
            std::vector<uint32_t> class_of(ring_length(side));
            Scratch scratch(f.level.scratch_size);
            uint32_t paths = 0;
            ASSERT_EQ(gim_read_seams(&f.info, f.bytes.data(), f.bytes.size(), 0, l, class_of.data(), &paths), GIM_OK);
            EXPECT_GE(paths, 2u);
            ASSERT_EQ(gim_decode_positions(&f.info, f.bytes.data(), f.bytes.size(), 0, l, x.data(), scratch.data(),
                                           f.level.scratch_size),
                      GIM_OK);
            std::map<uint32_t, std::array<float, 3>> at;
            for (uint32_t k = 0; k < class_of.size(); ++k) {
                const GridPoint p = ring_point(side, k);
                const float* v = &x[(size_t{p.row} * side + p.column) * 3];
                const auto [it, first] = at.try_emplace(class_of[k], std::array<float, 3>{v[0], v[1], v[2]});
                EXPECT_EQ(it->second, (std::array<float, 3>{v[0], v[1], v[2]})) << name << " level " << l;
            }
        }
    }
}

TEST(Decoder, CallersMistakesAreTold) {
    const Opened f(vector_file("torus-17-lossless"));
    std::vector<float> x(size_t{f.level.side} * f.level.side * 3);
    Scratch scratch(f.level.scratch_size + 16);
    auto* memory = static_cast<std::byte*>(scratch.data());
    const auto decode = [&](const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                            float* out, void* s, size_t s_size) {
        return gim_decode_positions(info, bytes, size, image, level, out, s, s_size);
    };
    const uint8_t* b = f.bytes.data();
    const size_t n = f.bytes.size(), s = f.level.scratch_size;
    EXPECT_EQ(decode(&f.info, b, n, 0, 0, x.data(), memory, s), GIM_OK);
    EXPECT_EQ(decode(nullptr, b, n, 0, 0, x.data(), memory, s), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(&f.info, nullptr, n, 0, 0, x.data(), memory, s), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(&f.info, b, n, 1, 0, x.data(), memory, s), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(&f.info, b, n, 0, 99, x.data(), memory, s), GIM_NO_SUCH_LEVEL);
    EXPECT_EQ(decode(&f.info, b, n, 0, 0, nullptr, memory, s), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(&f.info, b, n, 0, 0, x.data(), nullptr, s), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(&f.info, b, n, 0, 0, x.data(), memory + 4, s), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(&f.info, b, n, 0, 0, x.data(), memory, s - 1), GIM_SCRATCH_TOO_SMALL);
    EXPECT_EQ(gim_read_info(b, n, nullptr, nullptr), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_info(nullptr, n, nullptr, nullptr), GIM_BAD_ARGUMENT);
    // The gim_info belongs to another file.
    const auto other = vector_file("two-images-lossy");
    EXPECT_EQ(decode(&f.info, other.data(), other.size(), 0, 0, x.data(), memory, s), GIM_BAD_ARGUMENT);
    gim_chunk chunk;
    EXPECT_EQ(gim_read_chunk(&f.info, b, n, f.info.chunk_count, &chunk), GIM_BAD_ARGUMENT);
}

TEST(Decoder, WritesNothingBeyondItsOutputs) {
    const Opened f(vector_file("sphere-33-lossy"));
    // Exact allocations: the address sanitizer sees one element too many; without it the guards do.
    std::vector<float> mesh(f.level.vertex_count * 3 + 1, 7.0f), normals(f.level.vertex_count * 3 + 1, 7.0f);
    std::vector<uint32_t> triangles(f.level.triangle_count * 3 + 1, 7u);
    Scratch scratch(f.level.scratch_size + 16);
    uint8_t* guard = static_cast<uint8_t*>(scratch.data()) + f.level.scratch_size;
    std::fill_n(guard, 16, uint8_t{0xCD});
    ASSERT_EQ(gim_decode_mesh(&f.info, f.bytes.data(), f.bytes.size(), 0, 0, mesh.data(), normals.data(), nullptr,
                              triangles.data(), scratch.data(), f.level.scratch_size),
              GIM_OK);
    EXPECT_EQ(mesh.back(), 7.0f);
    EXPECT_EQ(normals.back(), 7.0f);
    EXPECT_EQ(triangles.back(), 7u);
    EXPECT_TRUE(std::all_of(guard, guard + 16, [](uint8_t b) { return b == 0xCD; }));
}

TEST(Decoder, ContentsOfScratchDoNotMatter) {
    const Opened f(vector_file("torus-33-lossy"));
    std::vector<float> zeros(size_t{f.level.side} * f.level.side * 3), ones = zeros;
    Scratch scratch(f.level.scratch_size);
    for (auto* out : {&zeros, &ones}) {
        std::memset(scratch.data(), out == &ones ? 0xFF : 0, scratch.size());
        ASSERT_EQ(gim_decode_positions(&f.info, f.bytes.data(), f.bytes.size(), 0, 0, out->data(), scratch.data(),
                                       f.level.scratch_size),
                  GIM_OK);
    }
    EXPECT_EQ(zeros, ones);
}

TEST(Decoder, EveryBitFlipOfAFileIsTold) {
    for (const char* name : {"open-5-lossless", "sphere-17-lossless", "two-images-lossy"}) {
        const auto bytes = vector_file(name);
        const auto whole = test::decode_all(bytes);
        for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
            auto flipped = bytes;
            flipped[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
            EXPECT_NE(test::decode_all(flipped).status, GIM_OK) << name << " bit " << bit;
        }
    }
}

TEST(Decoder, TextIsReadPackedOrNot) {
    for (const char* name : {"text-plain", "text-zstd"}) {
        const Opened f(vector_file(name));
        uint64_t size = 0;
        ASSERT_EQ(gim_read_text(&f.info, f.bytes.data(), f.bytes.size(), nullptr, 0, &size, nullptr, 0), GIM_OK);
        ASSERT_GT(size, 0u);
        std::string text(size, '\0');
        Scratch scratch(gim_text_scratch_size());
        ASSERT_EQ(gim_read_text(&f.info, f.bytes.data(), f.bytes.size(), text.data(), text.size(), &size,
                                scratch.data(), gim_text_scratch_size()),
                  GIM_OK)
            << name;
        EXPECT_EQ(text.find('\0'), std::string::npos);
        EXPECT_EQ(gim_read_text(&f.info, f.bytes.data(), f.bytes.size(), text.data(), text.size() - 1, &size,
                                scratch.data(), gim_text_scratch_size()),
                  GIM_SCRATCH_TOO_SMALL);
        auto damaged = f.bytes;
        damaged.back() ^= 1;  // META is the last chunk
        EXPECT_EQ(gim_read_text(&f.info, damaged.data(), damaged.size(), text.data(), text.size(), &size,
                                scratch.data(), gim_text_scratch_size()),
                  GIM_CHECKSUM);
    }
    const Opened packed(vector_file("text-zstd"));
    uint64_t size = 0;
    std::string text(100000, '\0');
    Scratch small(64);
    EXPECT_EQ(gim_read_text(&packed.info, packed.bytes.data(), packed.bytes.size(), text.data(), text.size(), &size,
                            small.data(), 64),
              GIM_SCRATCH_TOO_SMALL);
    const Opened silent(vector_file("open-5-lossless"));
    EXPECT_EQ(gim_read_text(&silent.info, silent.bytes.data(), silent.bytes.size(), text.data(), text.size(), &size,
                            nullptr, 0),
              GIM_OK);
    EXPECT_EQ(size, 0u);
}

TEST(Decoder, EveryStatusHasWords) {
    for (int s = -2; s <= 10; ++s) EXPECT_GT(std::strlen(gim_status_text(s)), 3u);
}

}  // namespace
}  // namespace gim
