#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "format/checksum.h"
#include "format/container.h"
#include "format/plane_code.h"
#include "format/ring.h"
#include "gim/decoder.hpp"
#include "tests/decoder/vector_file.h"

namespace gim {
namespace {

using Bytes = std::vector<uint8_t>;

using test::vector_file;

// The file with another payload in one of its plane chunks and with correct checksums.
Bytes with_plane(const Bytes& file, ChunkType type, const std::function<void(Bytes&)>& change) {
    Header header;
    EXPECT_EQ(parse_header(file, {}, &header), Status::kOk);
    std::vector<Chunk> chunks;
    Bytes payloads;
    ChunkWalk walk(header);
    Chunk chunk;
    for (uint64_t offset = 0; walk.next(&chunk, &offset);) {
        Bytes payload(file.begin() + static_cast<ptrdiff_t>(offset),
                      file.begin() + static_cast<ptrdiff_t>(offset + chunk.size));
        if (chunk.type == type) change(payload);
        chunk.size = payload.size();
        chunk.crc = crc16(payload);
        chunks.push_back(chunk);
        payloads.insert(payloads.end(), payload.begin(), payload.end());
    }
    Bytes out = serialize_header(header, chunks);
    out.insert(out.end(), payloads.begin(), payloads.end());
    out.shrink_to_fit();  // so that sanitizers notice one byte too many
    return out;
}

struct Plane {
    gim_status status = GIM_OK;
    DecoderPlane info;
    std::vector<float> values;
};
Plane decode(const Bytes& file, uint32_t kind, uint32_t level = 0, uint32_t image = 0) {
    Plane plane;
    Decoder decoder;
    plane.status = decoder.open(file);
    if (plane.status == GIM_OK) plane.status = decoder.read_plane(image, kind, level, &plane.info);
    if (plane.status != GIM_OK) return plane;
    plane.values.resize(size_t{plane.info.width} * plane.info.height * 3);
    plane.status = decoder.plane(plane.info, plane.values);
    return plane;
}

TEST(ReadPlane, TellsSidesThatDifferFromTheImages) {
    const Bytes file = vector_file("planes-sphere-17");
    EXPECT_EQ(decode(file, GIM_PLANE_NORMALS).info.width, 33u);
    EXPECT_EQ(decode(file, GIM_PLANE_COLORS).info.width, 9u);
    EXPECT_EQ(decode(file, GIM_PLANE_NORMALS, 2).info.width, 9u);
    EXPECT_EQ(decode(file, GIM_PLANE_COLORS, 7).status, GIM_NO_SUCH_LEVEL);
}

TEST(ReadPlane, AbsentPlanesAreToldByTheIndexAlone) {
    Bytes file = vector_file("planes-two-images");
    gim_info info;
    ASSERT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
    gim_plane_info plane;
    EXPECT_EQ(gim_read_plane_info(&info, file.data(), info.index_size, 0, GIM_PLANE_NORMALS, 0, &plane),
              GIM_NO_SUCH_PLANE);
    EXPECT_EQ(gim_read_plane_info(&info, file.data(), info.index_size, 0, GIM_PLANE_COLORS, 0, &plane),
              GIM_NEED_MORE_INPUT);
    EXPECT_EQ(gim_read_plane_info(&info, file.data(), file.size(), 2, GIM_PLANE_COLORS, 0, &plane), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_plane_info(&info, file.data(), file.size(), 0, 3, 0, &plane), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(file, GIM_PLANE_COLORS, 0, 1).info.width, 5u);
}

TEST(ReadPlane, NormalsAreUnitAndColorsBounded) {
    const Bytes file = vector_file("planes-sphere-17");
    const Plane normals = decode(file, GIM_PLANE_NORMALS);
    for (size_t i = 0; i < normals.values.size(); i += 3) {
        const float* n = &normals.values[i];
        EXPECT_NEAR(std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1, 1e-6);
    }
    for (const float v : decode(file, GIM_PLANE_COLORS).values) EXPECT_TRUE(v >= 0 && v <= 1) << v;
}

TEST(ReadPlane, SamplesOfOneSurfacePointAreEqualAtEveryLevel) {
    const Bytes file = vector_file("planes-sphere-17");
    for (uint32_t level = 0; level <= decode(file, GIM_PLANE_NORMALS).info.coarsest_level; ++level) {
        const Plane plane = decode(file, GIM_PLANE_NORMALS, level);
        ASSERT_EQ(plane.status, GIM_OK);
        // Every side is folded at its middle: sample t of a side is sample last - t.
        const uint32_t last = plane.info.width - 1;
        for (uint32_t s = 0; s < 4; ++s) {
            for (uint32_t t = 0; t <= last; ++t) {
                const auto at = [&](uint32_t k) {
                    const GridPoint p = ring_point(last + 1, k % (4 * last));
                    return &plane.values[(size_t{p.row} * (last + 1) + p.column) * 3];
                };
                for (int k = 0; k < 3; ++k) ASSERT_EQ(at(s * last + t)[k], at(s * last + last - t)[k]);
            }
        }
    }
}

TEST(ReadPlane, RefusesSmallScratchAndNullPointers) {
    const Bytes file = vector_file("planes-sphere-17");
    gim_info info;
    gim_plane_info plane;
    ASSERT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
    ASSERT_EQ(gim_read_plane_info(&info, file.data(), file.size(), 0, 1, 0, &plane), GIM_OK);
    std::vector<float> values(size_t{plane.width} * plane.height * 3);
    Scratch scratch(plane.scratch_size);
    const auto call = [&](float* to, void* memory, size_t size) {
        return gim_decode_plane(&info, file.data(), file.size(), 0, 1, 0, to, memory, size);
    };
    EXPECT_EQ(call(values.data(), scratch.data(), plane.scratch_size - 1), GIM_SCRATCH_TOO_SMALL);
    EXPECT_EQ(call(values.data(), nullptr, plane.scratch_size), GIM_BAD_ARGUMENT);
    EXPECT_EQ(call(nullptr, scratch.data(), plane.scratch_size), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_plane_info(&info, file.data(), file.size(), 0, 1, 0, nullptr), GIM_BAD_ARGUMENT);
    EXPECT_EQ(call(values.data(), scratch.data(), plane.scratch_size), GIM_OK);
}

// Texture coordinates find the samples of a plane of tiles at each of its levels. Those of one surface point are equal, and
// between two tiles the samples at their sides go on.
TEST(ReadPlane, PlanesOfTilesLieUnderTheirTextureCoordinates) {
    const Bytes file = vector_file("tiles-cube-planes");
    Decoder decoder;
    ASSERT_EQ(decoder.open(file), GIM_OK);
    DecoderLevel level;
    ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    const size_t samples = size_t{level.width} * level.height;
    std::vector<float> positions(3 * samples), texcoords(2 * samples);
    ASSERT_EQ(decoder.grid(level, {positions, {}, texcoords, {}}), GIM_OK);
    EXPECT_EQ(decode(file, GIM_PLANE_NORMALS).info.width, level.width);
    EXPECT_EQ(decode(file, GIM_PLANE_COLORS).info.width, 4 * (level.width - 1) + 1);
    EXPECT_EQ(decode(file, GIM_PLANE_COLORS).info.height, 4 * (level.height - 1) + 1);
    EXPECT_EQ(decode(file, GIM_PLANE_NORMALS, 1).status, GIM_NO_SUCH_LEVEL);
    EXPECT_EQ(decode(file, GIM_PLANE_COLORS, 3).status, GIM_NO_SUCH_LEVEL);
    for (uint32_t l = 0; l <= 2; ++l) {
        const Plane plane = decode(file, GIM_PLANE_COLORS, l);
        ASSERT_EQ(plane.status, GIM_OK);
        const uint32_t step = 4u >> l, width = plane.info.width;
        ASSERT_EQ(width, step * (level.width - 1) + 1);
        std::map<std::array<float, 3>, const float*> at_point;
        for (size_t i = 0; i < samples; ++i) {
            const float* value = &plane.values[3 * (i / level.width * step * width + i % level.width * step)];
            const std::array<float, 3> point = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
            ASSERT_FALSE(std::isnan(point[0]));
            const float* first = at_point.try_emplace(point, value).first->second;
            for (int k = 0; k < 3; ++k) ASSERT_EQ(first[k], value[k]) << l << ", " << i;
        }
        EXPECT_EQ(at_point.size(), 6 * 16 + 2u);
        // A slot has 5 samples. The gap behind it has step - 1 texels.
        for (uint32_t row = 0; row < plane.info.height; ++row) {
            for (uint32_t gap = 1; gap < step; ++gap) {
                const uint32_t last = 4 * step, nearest = gap < step / 2 ? last : last + step;
                for (uint32_t k = 0; k < 3; ++k)
                    ASSERT_EQ(plane.values[3 * (size_t{row} * width + last + gap) + k],
                              plane.values[3 * (size_t{row} * width + nearest) + k]);
            }
        }
    }
}

// Bad payloads with a right checksum: the decoder refuses them, or its values are finite and within bounds.
void expect_harmless(const Bytes& file) {
    for (const uint32_t kind : {GIM_PLANE_NORMALS, GIM_PLANE_COLORS, GIM_PLANE_DISPLACEMENTS}) {
        const Plane plane = decode(file, kind);
        if (plane.status == GIM_NO_SUCH_PLANE) continue;
        if (plane.status != GIM_OK) {
            EXPECT_TRUE(plane.status == GIM_MALFORMED || plane.status == GIM_UNSUPPORTED_VERSION ||
                        plane.status == GIM_LIMIT_EXCEEDED)
                << plane.status;
            continue;
        }
        const float most = kind == GIM_PLANE_DISPLACEMENTS ? std::numeric_limits<float>::max() : 1.000001f;
        for (const float v : plane.values) ASSERT_TRUE(v >= -most && v <= most) << v;
    }
}

TEST(ReadPlane, EveryTruncatedPayloadIsHarmless) {
    for (const char* name : {"planes-sphere-17", "tiles-cube-planes", "tiles-strip-planes"}) {
        const Bytes file = vector_file(name);
        for (const ChunkType type : {ChunkType::kNormals, ChunkType::kColors}) {
            size_t size = 0;
            with_plane(file, type, [&](Bytes& b) { size = b.size(); });
            for (size_t n = 0; n < size; ++n) expect_harmless(with_plane(file, type, [&](Bytes& b) { b.resize(n); }));
        }
    }
}

TEST(ReadPlane, EveryFlippedBitOfAPayloadIsHarmless) {
    for (const char* name :
         {"planes-sphere-17", "planes-two-images", "tiles-cube-planes", "tiles-genus-2-sharp-planes"}) {
        const Bytes file = vector_file(name);
        for (const ChunkType type : {ChunkType::kNormals, ChunkType::kColors}) {
            size_t size = 0;
            with_plane(file, type, [&](Bytes& b) { size = b.size(); });
            for (size_t bit = 0; bit < 8 * size; ++bit) {
                // An exponent of 13 makes a valid, huge plane. Its memory is not what we test.
                if (bit >= 40 && bit < 56) continue;
                expect_harmless(with_plane(
                    file, type, [&](Bytes& b) { b[bit / 8] = static_cast<uint8_t>(b[bit / 8] ^ 1u << bit % 8); }));
            }
        }
    }
}

}  // namespace
}  // namespace gim
