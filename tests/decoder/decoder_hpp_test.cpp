// gim/decoder.hpp gives what the C interface gives, and refuses spans of the wrong size.
#include "gim/decoder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/decoder/vector_file.h"

namespace gim {
namespace {

using Bytes = std::vector<uint8_t>;

using test::vector_file;

template <class T>
void append(const std::vector<T>& values, std::vector<T>* all) {
    all->insert(all->end(), values.begin(), values.end());
}

gim_status decode_levels(Decoder& decoder, uint32_t image, test::Decoded* out) {
    DecoderLevel level;
    for (uint32_t l = 0; l <= level.coarsest_level; ++l) {
        if (const gim_status s = decoder.read_level(image, l, &level); s != GIM_OK) return s;
        out->prefix = std::max(out->prefix, level.prefix_size);
        const size_t samples = size_t{level.width} * level.height, vertices = level.vertex_count;
        std::vector<float> grid(samples * 3), grid_normals(samples * 3), grid_texcoords(samples * 2);
        std::vector<float> positions(vertices * 3), normals(vertices * 3), texcoords(vertices * 2);
        std::vector<uint32_t> triangles(size_t{level.triangle_count} * 3), grid_triangles(triangles.size());
        gim_status s = decoder.grid(level, {grid, grid_normals, grid_texcoords, grid_triangles});
        if (s != GIM_OK) return s;
        s = decoder.mesh(level, {positions, normals, texcoords, triangles});
        if (s != GIM_OK) return s;
        append(grid, &out->samples);
        append(triangles, &out->triangles);
        append(normals, &out->vertices);
        append(texcoords, &out->vertices);
    }
    return GIM_OK;
}

gim_status decode_planes(Decoder& decoder, uint32_t image, uint32_t kind, test::Decoded* out) {
    DecoderPlane plane;
    for (uint32_t l = 0; l <= plane.coarsest_level; ++l) {
        gim_status s = decoder.read_plane(image, kind, l, &plane);
        if (s == GIM_NO_SUCH_PLANE) return GIM_OK;
        if (s != GIM_OK) return s;
        out->prefix = std::max(out->prefix, plane.prefix_size);
        std::vector<float> values(size_t{plane.width} * plane.height * 3);
        s = decoder.plane(plane, values);
        if (s != GIM_OK) return s;
        append(values, &out->planes);
    }
    return GIM_OK;
}

gim_status decode_labels(Decoder& decoder, uint32_t image, test::Decoded* out) {
    DecoderLevel level;
    for (uint32_t l = 0; l <= level.coarsest_level; ++l) {
        if (const gim_status s = decoder.read_level(image, l, &level); s != GIM_OK) return s;
        gim_labels_info of{};
        gim_status s = decoder.read_labels(level, &of);
        if (s == GIM_NO_SUCH_PLANE) return GIM_OK;
        if (s != GIM_OK) return s;
        out->prefix = std::max(out->prefix, of.prefix_size);
        Bytes labels(of.cell_count);
        s = decoder.labels(level, labels);
        if (s != GIM_OK) return s;
        append(labels, &out->labels);
    }
    return GIM_OK;
}

// As test::decode_all, with the C++ header.
test::Decoded decode_all(Decoder& decoder, const Bytes& file) {
    test::Decoded out;
    out.status = decoder.open(file);
    for (uint32_t i = 0; out.status == GIM_OK && i < decoder.info().image_count; ++i)
        out.status = decode_levels(decoder, i, &out);
    for (const uint32_t kind : {GIM_PLANE_NORMALS, GIM_PLANE_COLORS, GIM_PLANE_DISPLACEMENTS}) {
        for (uint32_t i = 0; out.status == GIM_OK && i < decoder.info().image_count; ++i)
            out.status = decode_planes(decoder, i, kind, &out);
    }
    for (uint32_t i = 0; out.status == GIM_OK && i < decoder.info().image_count; ++i)
        out.status = decode_labels(decoder, i, &out);
    return out;
}

TEST(DecoderHpp, AllVectorsDecodeAsThroughTheCInterface) {
    Decoder decoder;  // one for all files: none may affect the next
    size_t files = 0;
    for (const char* folder : {"valid", "invalid"}) {
        for (const auto& entry :
             std::filesystem::directory_iterator(std::string(GIM_SOURCE_DIR) + "/spec/vectors/" + folder)) {
            if (entry.path().extension() != ".gim") continue;
            SCOPED_TRACE(entry.path().filename());
            const Bytes file = test::read_bytes(entry.path());
            const test::Decoded expected = test::decode_all(file), decoded = decode_all(decoder, file);
            EXPECT_EQ(decoded.status, expected.status);
            EXPECT_EQ(decoded.prefix, expected.prefix);
            EXPECT_EQ(test::to_bytes(decoded.samples), test::to_bytes(expected.samples));
            EXPECT_EQ(decoded.triangles, expected.triangles);
            EXPECT_EQ(test::to_bytes(decoded.vertices), test::to_bytes(expected.vertices));
            EXPECT_EQ(test::to_bytes(decoded.planes), test::to_bytes(expected.planes));
            EXPECT_EQ(decoded.labels, expected.labels);
            ++files;
        }
    }
    EXPECT_GE(files, 28u);
}

TEST(DecoderHpp, SpansOfTheWrongSizeAreRefused) {
    for (const char* name : {"torus-33-lossy", "charts-pillow-lossy"}) {
        SCOPED_TRACE(name);
        const Bytes file = vector_file(name);
        Decoder decoder;
        DecoderLevel level;
        ASSERT_EQ(decoder.open(file), GIM_OK);
        ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
        const size_t triangle_size = size_t{level.triangle_count} * 3;
        for (const bool mesh : {true, false}) {
            const size_t n = mesh ? level.vertex_count : size_t{level.width} * level.height;
            std::vector<float> x(n * 3 + 1), normals(n * 3 + 1), uv(n * 2 + 1);
            std::vector<uint32_t> t(triangle_size + 1);
            const auto decode = [&](size_t a, size_t b, size_t c, size_t d) {
                const SurfaceSpans out = {std::span(x).first(a), std::span(normals).first(b), std::span(uv).first(c),
                                          std::span(t).first(d)};
                return mesh ? decoder.mesh(level, out) : decoder.grid(level, out);
            };
            EXPECT_EQ(decode(n * 3, n * 3, n * 2, triangle_size), GIM_OK);
            EXPECT_EQ(decode(n * 3, 0, 0, 0), GIM_OK);
            EXPECT_EQ(decode(0, 0, 0, 0), GIM_BAD_ARGUMENT);
            EXPECT_EQ(decode(n * 3 - 1, 0, 0, 0), GIM_BAD_ARGUMENT);
            EXPECT_EQ(decode(n * 3 + 1, 0, 0, 0), GIM_BAD_ARGUMENT);
            EXPECT_EQ(decode(n * 3, n * 3 - 1, 0, 0), GIM_BAD_ARGUMENT);
            EXPECT_EQ(decode(n * 3, n * 3 + 1, 0, 0), GIM_BAD_ARGUMENT);
            EXPECT_EQ(decode(n * 3, 0, n * 2 - 1, 0), GIM_BAD_ARGUMENT);
            EXPECT_EQ(decode(n * 3, 0, n * 2 + 1, 0), GIM_BAD_ARGUMENT);
            EXPECT_EQ(decode(n * 3, 0, 0, triangle_size - 1), GIM_BAD_ARGUMENT);
            EXPECT_EQ(decode(n * 3, 0, 0, triangle_size + 1), GIM_BAD_ARGUMENT);
        }
    }
}

TEST(DecoderHpp, PlanesAskForTheirSize) {
    const Bytes file = vector_file("planes-sphere-17");
    Decoder decoder;
    DecoderPlane plane;
    ASSERT_EQ(decoder.open(file), GIM_OK);
    EXPECT_EQ(decoder.read_plane(0, 7, 0, &plane), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decoder.read_plane(0, GIM_PLANE_COLORS, 99, &plane), GIM_NO_SUCH_LEVEL);
    ASSERT_EQ(decoder.read_plane(0, GIM_PLANE_COLORS, 0, &plane), GIM_OK);
    std::vector<float> values(size_t{plane.width} * plane.height * 3 + 1);
    EXPECT_EQ(decoder.plane(plane, std::span(values).first(values.size() - 1)), GIM_OK);
    EXPECT_EQ(decoder.plane(plane, values), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decoder.plane(plane, std::span(values).first(values.size() - 2)), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decoder.plane(plane, {}), GIM_BAD_ARGUMENT);
}

TEST(DecoderHpp, TextComesInASpanOfItsLength) {
    for (const char* name : {"text-plain", "text-zstd"}) {
        const Bytes file = vector_file(name);
        Decoder decoder;
        uint64_t size = 0;
        ASSERT_EQ(decoder.open(file), GIM_OK);
        ASSERT_EQ(decoder.read_text_size(&size), GIM_OK);
        ASSERT_GT(size, 0u);
        std::string text(size + 1, '\0');
        EXPECT_EQ(decoder.text(std::span(text).first(size)), GIM_OK);
        EXPECT_EQ(text.find('\0'), size);
        EXPECT_EQ(decoder.text(text), GIM_BAD_ARGUMENT);
        EXPECT_EQ(decoder.text(std::span(text).first(size - 1)), GIM_SCRATCH_TOO_SMALL);
        EXPECT_EQ(decoder.text({}), GIM_SCRATCH_TOO_SMALL);
    }
    const Bytes silent = vector_file("open-5-lossless");
    Decoder decoder;
    ASSERT_EQ(decoder.open(silent), GIM_OK);
    EXPECT_EQ(decoder.text({}), GIM_OK);
}

TEST(DecoderHpp, SeamsAreThoseOfTheCInterface) {
    const Bytes file = vector_file("torus-33-lossy");
    Decoder decoder;
    DecoderLevel level;
    ASSERT_EQ(decoder.open(file), GIM_OK);
    ASSERT_EQ(decoder.read_level(0, 1, &level), GIM_OK);
    std::vector<uint32_t> class_of(size_t{level.side - 1} * 4), expected(class_of.size());
    uint32_t paths = 0, expected_paths = 0;
    ASSERT_EQ(gim_read_seams(&decoder.info(), file.data(), file.size(), 0, 1, expected.data(), &expected_paths),
              GIM_OK);
    EXPECT_EQ(decoder.seams(level, class_of, &paths), GIM_OK);
    EXPECT_EQ(class_of, expected);
    EXPECT_EQ(paths, expected_paths);
    EXPECT_EQ(decoder.seams(level, {}, &paths), GIM_OK);
    EXPECT_EQ(decoder.seams(level, std::span(class_of).first(class_of.size() - 1), &paths), GIM_BAD_ARGUMENT);

    const Bytes charts = vector_file("charts-pillow-lossy");
    ASSERT_EQ(decoder.open(charts), GIM_OK);
    ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    EXPECT_EQ(decoder.seams(level, class_of, &paths), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decoder.seams(level, {}, &paths), GIM_OK);
    EXPECT_EQ(paths, 6u);
}

TEST(DecoderHpp, WhatIsNotOpenIsRefused) {
    Decoder decoder;
    DecoderLevel level;
    DecoderPlane plane;
    gim_chunk chunk;
    uint64_t size = 0;
    EXPECT_NE(decoder.read_level(0, 0, &level), GIM_OK);
    EXPECT_NE(decoder.read_plane(0, GIM_PLANE_COLORS, 0, &plane), GIM_OK);
    EXPECT_NE(decoder.read_chunk(0, &chunk), GIM_OK);
    EXPECT_NE(decoder.read_text_size(&size), GIM_OK);
    const Bytes file = vector_file("sphere-17-lossless");
    ASSERT_EQ(decoder.open(file), GIM_OK);
    ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    EXPECT_EQ(decoder.open(std::span(file).first(20)), GIM_NEED_MORE_INPUT);
    EXPECT_EQ(decoder.info().image_count, 0u);
    std::vector<float> x(size_t{level.vertex_count} * 3);
    EXPECT_NE(decoder.mesh(level, {x, {}, {}, {}}), GIM_OK);
    const gim_limits small = {100, 1, 9};
    EXPECT_EQ(decoder.open(file, &small), GIM_LIMIT_EXCEEDED);
}

TEST(Scratch, IsAlignedMovesAndTellsWhenThereIsNoMemory) {
    Scratch scratch;
    EXPECT_EQ(scratch.data(), nullptr);
    for (const size_t size : {1u, 17u, 1000u}) {
        ASSERT_TRUE(scratch.reserve(size));
        EXPECT_EQ(reinterpret_cast<uintptr_t>(scratch.data()) % Scratch::kAlignment, 0u);
        EXPECT_GE(scratch.size(), size);
    }
    void* memory = scratch.data();
    ASSERT_TRUE(scratch.reserve(10));
    EXPECT_EQ(scratch.data(), memory);
    Scratch other(std::move(scratch));
    EXPECT_EQ(other.data(), memory);
    EXPECT_EQ(scratch.data(), nullptr);
    scratch = std::move(other);
    EXPECT_EQ(scratch.data(), memory);
#ifndef __SANITIZE_ADDRESS__  // which ends the program instead
    EXPECT_FALSE(scratch.reserve(uint64_t{1} << 62));
    EXPECT_EQ(scratch.size(), 0u);
#endif
}

}  // namespace
}  // namespace gim
