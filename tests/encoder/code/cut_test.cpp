// Files that lack fine levels decode to the same bits as the files that they were cut from.
#include "gim/cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/decoder/vectors.h"

namespace gim {
namespace {

using test::read_bytes;
namespace fs = std::filesystem;
using Bytes = std::vector<uint8_t>;

std::vector<Bytes> valid_vectors() {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(fs::path(GIM_SOURCE_DIR) / "spec/vectors/valid"))
        if (entry.path().extension() == ".gim") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<Bytes> files;
    for (const fs::path& path : paths) files.push_back(read_bytes(path));
    return files;
}

gim_info info_of(const Bytes& file) {
    gim_info info{};
    EXPECT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
    return info;
}

uint32_t last_common_level(const Bytes& file) {
    const gim_info info = info_of(file);
    uint32_t last = GIM_MAX_LEVELS;
    for (uint32_t image = 0; image < info.image_count; ++image) {
        gim_level_info level{};
        EXPECT_EQ(gim_read_level_info(&info, file.data(), file.size(), image, 0, &level), GIM_OK);
        last = std::min(last, level.coarsest_level);
    }
    return last;
}

// What decode_all() gives from a level on.
test::Decoded decode_from(const Bytes& file, uint32_t level) {
    test::Decoded out;
    const gim_info info = info_of(file);
    for (uint32_t image = 0; image < info.image_count; ++image) {
        uint32_t coarsest = level;
        for (uint32_t l = level; out.status == GIM_OK && l <= coarsest; ++l)
            out.status = test::decode_one(info, file, image, l, &coarsest, &out);
    }
    for (const uint32_t kind : {GIM_PLANE_NORMALS, GIM_PLANE_COLORS})
        for (uint32_t image = 0; out.status == GIM_OK && image < info.image_count; ++image)
            out.status = test::decode_plane(info, file, image, kind, &out);
    for (uint32_t image = 0; out.status == GIM_OK && image < info.image_count; ++image)
        out.status = test::decode_labels(info, file, image, &out, level);
    return out;
}

Bytes cut_at(const Bytes& file, uint32_t level) {
    CutOptions options;
    options.level = level;
    const Result<CutFile> made = cut(file, options);
    EXPECT_TRUE(made.ok()) << made.error().message;
    EXPECT_EQ(made.value().level, level);
    return made.value().bytes;
}

TEST(CutFile, EveryLevelOfEveryVectorKeepsItsBits) {
    size_t cuts = 0;
    for (const Bytes& file : valid_vectors()) {
        for (uint32_t level = 1; level <= last_common_level(file); ++level, ++cuts) {
            const Bytes made = cut_at(file, level);
            const gim_info whole = info_of(file), info = info_of(made);
            EXPECT_LT(made.size(), file.size() + 2);
            EXPECT_EQ(info.file_size, made.size());
            EXPECT_EQ(info.level_count, whole.level_count - level);
            EXPECT_EQ(info.has_boxes, whole.has_boxes);
            EXPECT_EQ(std::memcmp(&info.box, &whole.box, sizeof info.box), 0);
            for (uint32_t l = 0; l < info.level_count; ++l)
                EXPECT_EQ(info.level_max_error[l], whole.level_max_error[l + level]);
            const test::Decoded expected = decode_from(file, level), decoded = decode_from(made, 0);
            ASSERT_EQ(decoded.status, GIM_OK);
            EXPECT_EQ(test::to_bytes(decoded.samples), test::to_bytes(expected.samples));
            EXPECT_EQ(decoded.triangles, expected.triangles);
            EXPECT_EQ(test::to_bytes(decoded.vertices), test::to_bytes(expected.vertices));
            EXPECT_EQ(test::to_bytes(decoded.planes), test::to_bytes(expected.planes));
            EXPECT_EQ(decoded.labels, expected.labels);
        }
    }
    EXPECT_GT(cuts, 40u);
}

TEST(CutFile, LevelZeroKeepsAllBytes) {
    for (const Bytes& file : valid_vectors()) {
        const gim_info info = info_of(file);
        EXPECT_EQ(cut_at(file, 0), Bytes(file.begin(), file.begin() + static_cast<ptrdiff_t>(info.file_size)));
    }
}

TEST(CutFile, TwoCutsAreOneCut) {
    for (const Bytes& file : valid_vectors()) {
        if (last_common_level(file) < 2) continue;
        EXPECT_EQ(cut_at(cut_at(file, 1), 1), cut_at(file, 2));
    }
}

TEST(CutFile, TheBeginningOfAFileIsEnough) {
    for (const Bytes& file : valid_vectors()) {
        const uint32_t last = last_common_level(file);
        const gim_info info = info_of(file);
        uint64_t prefix = 0;
        for (uint32_t image = 0; image < info.image_count; ++image) {
            gim_level_info level{};
            ASSERT_EQ(gim_read_level_info(&info, file.data(), file.size(), image, last, &level), GIM_OK);
            prefix = std::max(prefix, level.prefix_size);
        }
        CutOptions options;
        options.level = last;
        options.drop_normals = options.drop_colors = options.drop_displacements = options.drop_labels = true;
        options.drop_text = true;
        const Result<CutFile> whole = cut(file, options);
        ASSERT_TRUE(whole.ok());
        const auto end = file.begin() + static_cast<ptrdiff_t>(prefix);
        const Result<CutFile> from_prefix = cut(Bytes(file.begin(), end), options);
        // Chunks of kinds that a reader does not know are kept, and may lie behind the levels.
        if (from_prefix.ok()) {
            EXPECT_EQ(from_prefix.value().bytes, whole.value().bytes);
        } else {
            EXPECT_GT(whole.value().bytes.size() + 4, prefix);
        }
        EXPECT_FALSE(cut(Bytes(file.begin(), end - 1), options).ok());
    }
}

TEST(CutFile, PlanesAndTextAreLeftOutIfAsked) {
    for (const Bytes& file : valid_vectors()) {
        CutOptions options;
        options.drop_normals = options.drop_colors = options.drop_displacements = options.drop_labels = true;
        options.drop_text = true;
        const Result<CutFile> made = cut(file, options);
        ASSERT_TRUE(made.ok()) << made.error().message;
        const Bytes& bytes = made.value().bytes;
        const gim_info info = info_of(bytes);
        gim_plane_info plane;
        for (const uint32_t kind : {GIM_PLANE_NORMALS, GIM_PLANE_COLORS, GIM_PLANE_DISPLACEMENTS})
            EXPECT_EQ(gim_read_plane_info(&info, bytes.data(), bytes.size(), 0, kind, 0, &plane), GIM_NO_SUCH_PLANE);
        gim_labels_info labels;
        EXPECT_EQ(gim_read_labels_info(&info, bytes.data(), bytes.size(), 0, 0, &labels), GIM_NO_SUCH_PLANE);
        uint64_t text = 0;
        EXPECT_EQ(gim_read_text(&info, bytes.data(), bytes.size(), nullptr, 0, &text, nullptr, 0), GIM_OK);
        EXPECT_EQ(text, 0u);
    }
}

TEST(CutFile, TheFinestLevelThatFitsIsTaken) {
    const Bytes file = read_bytes(fs::path(GIM_SOURCE_DIR) / "spec/vectors/valid/sphere-33-lossy.gim");
    const uint32_t last = last_common_level(file);
    ASSERT_GE(last, 1u);
    for (uint32_t level = 0; level <= last; ++level) {
        const size_t size = cut_at(file, level).size();
        CutOptions options;
        options.most_bytes = size;
        const Result<CutFile> fits = cut(file, options);
        ASSERT_TRUE(fits.ok());
        EXPECT_EQ(fits.value().level, level);
        options.most_bytes = size - 1;
        const Result<CutFile> smaller = cut(file, options);
        ASSERT_EQ(smaller.ok(), level < last);
        if (smaller.ok()) {
            EXPECT_EQ(smaller.value().level, level + 1);
        }
    }
}

TEST(CutFile, WhatCannotBeCutIsAnError) {
    const Bytes file = read_bytes(fs::path(GIM_SOURCE_DIR) / "spec/vectors/valid/sphere-33-lossy.gim");
    CutOptions options;
    options.level = last_common_level(file) + 1;
    EXPECT_FALSE(cut(file, options).ok());
    options.level = UINT32_MAX;
    EXPECT_FALSE(cut(file, options).ok());
    options.level = 0;
    EXPECT_FALSE(cut({}, options).ok());
    Bytes damaged = file;
    damaged[damaged.size() - 3] ^= 1;
    EXPECT_FALSE(cut(damaged, options).ok());
    options.level = 1;  // the damage is in what is cut off
    EXPECT_TRUE(cut(damaged, options).ok());
}

}  // namespace
}  // namespace gim
