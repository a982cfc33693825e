// Tests every vector of spec/vectors, and every way of spoiling the valid ones.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/decoder/vectors.h"

namespace gim {
namespace {

using namespace gim::test;
namespace fs = std::filesystem;

std::vector<fs::path> vectors_in(const char* folder) {
    std::vector<fs::path> paths;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(fs::path(GIM_SOURCE_DIR) / "spec/vectors" / folder, none)) {
        if (entry.path().extension() == ".gim") paths.push_back(entry.path());
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

TEST(Conformance, BothFoldersHoldVectors) {
    EXPECT_GE(vectors_in("valid").size(), 8u);
    EXPECT_GE(vectors_in("invalid").size(), 20u);
}

TEST(Conformance, ValidFilesDecodeToTheExpectedBits) {
    for (const fs::path& path : vectors_in("valid")) {
        SCOPED_TRACE(path.filename());
        const Decoded decoded = decode_all(read_bytes(path));
        ASSERT_EQ(decoded.status, GIM_OK);
        EXPECT_FALSE(decoded.samples.empty());
        EXPECT_EQ(to_bytes(decoded.samples), read_bytes(fs::path(path).replace_extension(".f32")));
        EXPECT_EQ(to_bytes(decoded.triangles), read_bytes(fs::path(path).replace_extension(".tri")));
        EXPECT_EQ(to_bytes(decoded.vertices), read_bytes(fs::path(path).replace_extension(".vtx")));
        EXPECT_EQ(to_bytes(decoded.planes), read_bytes(fs::path(path).replace_extension(".pln")));
        EXPECT_EQ(to_bytes(decoded.details), read_bytes(fs::path(path).replace_extension(".dsp")));
        EXPECT_EQ(to_bytes(decoded.bounds), read_bytes(fs::path(path).replace_extension(".bnd")));
        EXPECT_EQ(decoded.labels, read_bytes(fs::path(path).replace_extension(".lbl")));
        EXPECT_EQ(to_bytes(decoded.raster), read_bytes(fs::path(path).replace_extension(".ras")));
    }
}

TEST(Conformance, InvalidFilesAreRefusedForTheRightReason) {
    for (const fs::path& path : vectors_in("invalid")) {
        SCOPED_TRACE(path.filename());
        const gim_status expected = status_of_name(path.filename().string());
        ASSERT_NE(expected, GIM_OK);
        EXPECT_EQ(decode_all(read_bytes(path)).status, expected);
    }
}

TEST(Conformance, EveryTruncationAsksForMore) {
    for (const fs::path& path : vectors_in("valid")) {
        SCOPED_TRACE(path.filename());
        const std::vector<uint8_t> file = read_bytes(path);
        const Decoded whole = decode_all(file);
        for (size_t n = 0; n < file.size(); ++n) {
            const Decoded cut = decode_all({file.begin(), file.begin() + static_cast<ptrdiff_t>(n)});
            ASSERT_EQ(cut.status, n < whole.prefix ? GIM_NEED_MORE_INPUT : GIM_OK) << n << " of " << file.size();
        }
    }
}

TEST(Conformance, NoDamagedByteChangesTheSurfaceUnnoticed) {
    for (const fs::path& path : vectors_in("valid")) {
        SCOPED_TRACE(path.filename());
        std::vector<uint8_t> file = read_bytes(path);
        const Decoded whole = decode_all(file);
        for (size_t i = 0; i < file.size(); ++i) {
            const uint8_t kept = file[i];
            file[i] = static_cast<uint8_t>(kept ^ (1u << i % 8));
            const Decoded damaged = decode_all(file);
            if (damaged.status == GIM_OK) {
                ASSERT_EQ(to_bytes(damaged.samples), to_bytes(whole.samples)) << "byte " << i;
                ASSERT_EQ(damaged.triangles, whole.triangles) << "byte " << i;
                ASSERT_EQ(to_bytes(damaged.planes), to_bytes(whole.planes)) << "byte " << i;
                ASSERT_EQ(to_bytes(damaged.details), to_bytes(whole.details)) << "byte " << i;
                ASSERT_EQ(to_bytes(damaged.bounds), to_bytes(whole.bounds)) << "byte " << i;
                ASSERT_EQ(damaged.labels, whole.labels) << "byte " << i;
            }
            file[i] = kept;
        }
    }
}

}  // namespace
}  // namespace gim
