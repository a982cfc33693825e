// The glTF reader on compressed files, which the libraries' own encoders make: Draco and meshopt.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <draco/point_cloud/point_cloud_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

#include "tests/tools/gltf_builder.h"

namespace gim {
namespace {

using test::GltfBuilder;
using test::GltfRead;
using test::Json;
using test::read_gltf_file;
using test::read_gltf_text;
using test::says;
using Point = std::array<double, 3>;

// A bumpy grid of side * side vertices, so that the codecs have something to predict.
constexpr uint32_t kSide = 9;
constexpr size_t kVertices = kSide * kSide;

std::vector<float> grid_positions() {
    std::vector<float> positions;
    for (size_t i = 0; i < kVertices; ++i) {
        const auto x = static_cast<float>(i % kSide);
        const auto y = static_cast<float>(i / kSide);
        for (const float value : {x, y, std::sin(x) * std::cos(y)}) positions.push_back(value);
    }
    return positions;
}

std::vector<uint32_t> grid_indices() {
    std::vector<uint32_t> indices;
    for (uint32_t y = 0; y + 1 < kSide; ++y) {
        for (uint32_t x = 0; x + 1 < kSide; ++x) {
            const uint32_t a = y * kSide + x;
            for (const uint32_t i : {a, a + 1, a + kSide, a + 1, a + 1 + kSide, a + kSide}) {
                indices.push_back(i);
            }
        }
    }
    return indices;
}

// The triangles as points in thousandths, in an order that does not depend on the file's.
std::vector<std::array<Point, 3>> surface(const TriangleMesh& mesh) {
    std::vector<std::array<Point, 3>> triangles;
    for (const auto& triangle : mesh.triangles) {
        std::array<Point, 3> corners;
        for (size_t k = 0; k < 3; ++k) {
            for (size_t axis = 0; axis < 3; ++axis) {
                corners[k][axis] = std::round(mesh.positions[triangle[k]][axis] * 1000) + 0.0;
            }
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        triangles.push_back(corners);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

GltfBuilder plain_grid() {
    GltfBuilder file;
    file.attribute("POSITION", file.accessor("VEC3", grid_positions()));
    file.primitive()["indices"] = file.accessor("SCALAR", grid_indices());
    return file;
}

std::vector<std::array<Point, 3>> grid_surface() { return surface(read_gltf_file(plain_grid()).mesh); }

// For codecs that lose up to a thousandth. The whole numbers x and y give both the same order.
void expect_near_grid(const TriangleMesh& mesh) {
    const std::vector<std::array<Point, 3>> found = surface(mesh);
    const std::vector<std::array<Point, 3>> right = grid_surface();
    ASSERT_EQ(found.size(), right.size());
    for (size_t t = 0; t < right.size(); ++t) {
        for (size_t k = 0; k < 3; ++k) {
            for (size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[t][k][axis], right[t][k][axis], 2);
        }
    }
}

// ---- Draco ----------------------------------------------------------------------------------------------------------

struct Packed {
    std::vector<uint8_t> bytes;
    int position = 0, texcoord = 0, color = 0;  // unique ids
};

Packed draco_grid(int method, int position_bits = 0) {
    const std::vector<float> positions = grid_positions();
    const std::vector<uint32_t> indices = grid_indices();
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(indices.size() / 3));
    Packed packed;
    packed.position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    packed.texcoord = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    packed.color = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
    for (uint32_t f = 0; f < indices.size() / 3; ++f) {
        std::array<const float*, 3> p = {};
        std::array<std::array<float, 2>, 3> uv = {};
        std::array<std::array<uint8_t, 4>, 3> color = {};
        for (size_t k = 0; k < 3; ++k) {
            p[k] = positions.data() + size_t{3} * indices[3 * f + k];
            uv[k] = {p[k][0] / 8, p[k][1] / 8};
            color[k] = {static_cast<uint8_t>(p[k][0] * 31), 255, 0, 255};
        }
        const draco::FaceIndex face(f);
        builder.SetAttributeValuesForFace(packed.position, face, p[0], p[1], p[2]);
        builder.SetAttributeValuesForFace(packed.texcoord, face, uv[0].data(), uv[1].data(), uv[2].data());
        builder.SetAttributeValuesForFace(packed.color, face, color[0].data(), color[1].data(), color[2].data());
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::ExpertEncoder encoder(*mesh);
    encoder.SetEncodingMethod(method);
    if (position_bits > 0) encoder.SetAttributeQuantization(packed.position, position_bits);
    draco::EncoderBuffer out;
    EXPECT_TRUE(encoder.EncodeToBuffer(&out).ok());
    packed.bytes.assign(out.data(), out.data() + out.size());
    for (int* id : {&packed.position, &packed.texcoord, &packed.color}) {
        *id = static_cast<int>(mesh->attribute(*id)->unique_id());
    }
    return packed;
}

GltfBuilder draco_file(const Packed& packed) {
    GltfBuilder file;
    file.use_extension("KHR_draco_mesh_compression");
    const auto add = [&](int type, const std::string& width, size_t count) {
        return file.add("accessors", {{"componentType", type}, {"count", count}, {"type", width}});
    };
    file.attribute("POSITION", add(5126, "VEC3", kVertices));
    file.attribute("TEXCOORD_0", add(5126, "VEC2", kVertices));
    file.attribute("COLOR_0", add(5121, "VEC4", kVertices));
    file.root["accessors"].back()["normalized"] = true;
    file.primitive()["indices"] = add(5123, "SCALAR", grid_indices().size());
    file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", file.view(packed.bytes)},
        {"attributes", {{"POSITION", packed.position}, {"TEXCOORD_0", packed.texcoord}, {"COLOR_0", packed.color}}}};
    return file;
}

TEST(GltfDraco, BothMethodsGiveTheSurfaceBack) {
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const GltfRead read = read_gltf_file(draco_file(draco_grid(method)));
        ASSERT_TRUE(read.ok) << read.message;
        EXPECT_TRUE(read.warnings.empty()) << read.all_warnings;
        EXPECT_EQ(surface(read.mesh), grid_surface()) << method;
        // Colours are those of the vertices: red tells x.
        ASSERT_EQ(read.mesh.appearance.corner_colors.size(), read.mesh.triangles.size());
        for (size_t t = 0; t < read.mesh.triangles.size(); ++t) {
            const double x = read.mesh.positions[read.mesh.triangles[t][0]][0];
            const double linear = std::floor(x * 31) / 255;
            const double srgb = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
            EXPECT_NEAR(static_cast<double>(read.mesh.appearance.corner_colors[t][0][0]), srgb, 1e-5);
        }
    }
}

TEST(GltfDraco, QuantizedPositionsComeBackNear) {
    const GltfRead read = read_gltf_file(draco_file(draco_grid(draco::MESH_EDGEBREAKER_ENCODING, 16)));
    ASSERT_TRUE(read.ok) << read.message;
    expect_near_grid(read.mesh);
}

TEST(GltfDraco, TextureCoordinatesAndOldModesAreRead) {
    GltfBuilder file = draco_file(draco_grid(draco::MESH_EDGEBREAKER_ENCODING));
    file.primitive()["mode"] = 5;  // the compressed triangles are a list all the same
    file.primitive()["material"] = 0;
    file.root["materials"] = Json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
    file.root["textures"] = Json::array({{{"source", 0}}});
    const std::string bmp = "Qk06AAAAAAAAADYAAAAoAAAAAQAAAAEAAAABABgAAAAAAAQAAAAAAAAAAAAAAAAAAAAAAAAA/wAAAA==";
    file.root["images"] = Json::array({{{"uri", "data:image/bmp;base64," + bmp}}});
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(surface(read.mesh), grid_surface());
    ASSERT_EQ(read.mesh.appearance.corner_texcoords.size(), read.mesh.triangles.size()) << read.all_warnings;
    for (size_t t = 0; t < read.mesh.triangles.size(); ++t) {
        const Point& p = read.mesh.positions[read.mesh.triangles[t][1]];
        EXPECT_NEAR(static_cast<double>(read.mesh.appearance.corner_texcoords[t][1][0]), p[0] / 8, 1e-3);
    }
}

TEST(GltfDraco, AttributesOutsideOfTheCompressedOnesAreReadBesides) {
    GltfBuilder file = draco_file(draco_grid(draco::MESH_SEQUENTIAL_ENCODING));
    file.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase("COLOR_0");
    file.attribute("COLOR_0", file.accessor("VEC3", std::vector<float>(3 * kVertices, 0.0F)));
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(read.mesh.appearance.corner_colors.at(0)[0], (std::array<float, 3>{0, 0, 0}));
}

TEST(GltfDraco, WhatCannotBeDecodedIsNamed) {
    const Packed packed = draco_grid(draco::MESH_EDGEBREAKER_ENCODING);
    Packed other = packed;
    other.position = 77;
    EXPECT_TRUE(says(read_gltf_file(draco_file(other)).message, "no attribute 77"));
    for (const auto& [at, value, word] : std::vector<std::tuple<size_t, uint8_t, std::string>>{
             {0, 'X', "header"}, {5, 3, "bitstream 3.2"}, {7, 0, "points"}, {8, 9, "method"}}) {
        other = packed;
        other.bytes[at] = value;
        EXPECT_TRUE(says(read_gltf_file(draco_file(other)).message, word)) << read_gltf_file(draco_file(other)).message;
    }
    GltfBuilder missing = draco_file(packed);
    missing.primitive()["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 9;
    EXPECT_FALSE(read_gltf_file(missing).ok);
    EXPECT_TRUE(says(read_gltf_text(draco_file(packed).text(), "", 60000).message, "--max-memory"));
}

TEST(GltfDraco, ClaimsOfMoreThanTheMemoryLimitAreRefusedAtOnce) {
    // Header, metadata flag off; sequential: triangles, points; edgebreaker: traversal, vertices, triangles, attributes.
    const std::string huge = "\xFF\xFF\xFF\xFF\x04";  // 1,342,177,279
    for (const std::string& rest : {std::string("\1\0\0\0", 4) + huge + huge + std::string(40, '\1'),
                                    std::string("\1\1\0\0", 4) + std::string(1, '\0') + huge + huge + "\1" + huge}) {
        const std::string stream = "DRACO" + std::string("\2\2", 2) + rest;
        const Packed packed = {{stream.begin(), stream.end()}, 0, 1, 2};
        EXPECT_TRUE(says(read_gltf_file(draco_file(packed)).message, "--max-memory"))
            << read_gltf_file(draco_file(packed)).message;
    }
}

// Every one must end, within the memory limit, with a mesh or a message.
void spoil(const std::vector<uint8_t>& bytes, const std::function<void(const std::vector<uint8_t>&)>& read) {
    for (size_t size = 0; size < bytes.size(); size += 1 + size / 16) {
        read({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
    }
    uint32_t random = 1;
    for (int i = 0; i < 400; ++i) {
        std::vector<uint8_t> spoilt = bytes;
        for (int k = 0; k < 1 + i % 3; ++k) {
            random = random * 1664525U + 1013904223U;
            spoilt[(random >> 8) % std::min<size_t>(spoilt.size(), i % 2 == 0 ? 64 : spoilt.size())] =
                static_cast<uint8_t>(random >> 24);
        }
        read(spoilt);
    }
}

TEST(GltfDraco, SpoiltBytesEndWithAMeshOrAMessage) {
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const Packed packed = draco_grid(method, 11);
        spoil(packed.bytes, [&](const std::vector<uint8_t>& bytes) {
            Packed spoilt = packed;
            spoilt.bytes = bytes;
            const GltfRead read = read_gltf_text(draco_file(spoilt).text(), "", uint64_t{64} << 20);
            if (!read.ok) {
                EXPECT_FALSE(read.message.empty());
            }
        });
    }
}

// ---- meshopt --------------------------------------------------------------------------------------------------------

template <class T>
std::vector<uint8_t> pack_vertices(const std::vector<T>& values, size_t count, size_t stride) {
    std::vector<uint8_t> out(meshopt_encodeVertexBufferBound(count, stride));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), count, stride));
    return out;
}

std::vector<uint8_t> pack_triangles(const std::vector<uint32_t>& indices) {
    std::vector<uint8_t> out(meshopt_encodeIndexBufferBound(indices.size(), kVertices));
    out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
    return out;
}

std::vector<uint8_t> pack_sequence(const std::vector<uint32_t>& indices) {
    std::vector<uint8_t> out(meshopt_encodeIndexSequenceBound(indices.size(), kVertices));
    out.resize(meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), indices.size()));
    return out;
}

// Makes a buffer view compressed: its own buffer is one without data, and `packed` goes to buffer 0.
Json& compress(GltfBuilder& file, size_t view, const std::vector<uint8_t>& packed, const Json& layout,
               const std::string& name = "EXT_meshopt_compression") {
    const size_t place = file.view(packed);
    Json extension = file.root["bufferViews"][place];
    extension.update(layout);
    Json& compressed = file.root["bufferViews"][view];
    compressed["buffer"] = 1;
    compressed["extensions"][name] = extension;
    return compressed["extensions"][name];
}

// The text of a file with buffer 0 and a fallback buffer without data.
std::string packed_text(const GltfBuilder& file) {
    Json root = Json::parse(file.text());
    root["buffers"].push_back(
        {{"byteLength", 100000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    return root.dump();
}

GltfBuilder meshopt_file(const std::string& name = "EXT_meshopt_compression") {
    GltfBuilder file = plain_grid();
    file.use_extension(name);
    compress(file, 0, pack_vertices(grid_positions(), kVertices, 12),
             {{"mode", "ATTRIBUTES"}, {"count", kVertices}, {"byteStride", 12}}, name);
    compress(file, 1, pack_triangles(grid_indices()),
             {{"mode", "TRIANGLES"}, {"count", grid_indices().size()}, {"byteStride", 4}}, name);
    return file;
}

Json& position_packing(GltfBuilder& file) {
    return file.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
}

TEST(GltfMeshopt, VerticesTrianglesAndSequencesComeBack) {
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        const GltfRead read = read_gltf_text(packed_text(meshopt_file(name)));
        ASSERT_TRUE(read.ok) << read.message;
        EXPECT_TRUE(read.warnings.empty()) << read.all_warnings;
        EXPECT_EQ(surface(read.mesh), grid_surface());
    }
    GltfBuilder sequence = plain_grid();
    compress(sequence, 1, pack_sequence(grid_indices()),
             {{"mode", "INDICES"}, {"count", grid_indices().size()}, {"byteStride", 4}});
    const GltfRead read = read_gltf_text(packed_text(sequence));
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(surface(read.mesh), grid_surface());
}

TEST(GltfMeshopt, ShortIndicesAndQuantizedVerticesComeBack) {
    GltfBuilder file = plain_grid();
    std::vector<uint16_t> quantized;
    for (size_t i = 0; i < kVertices; ++i) {
        for (const size_t value : {i % kSide, i / kSide, size_t{5}, size_t{0}}) {
            quantized.push_back(static_cast<uint16_t>(value));
        }
    }
    file.root["accessors"][0]["componentType"] = 5123;
    file.root["bufferViews"][0]["byteStride"] = 8;
    file.root["accessors"][1]["componentType"] = 5123;
    compress(file, 0, pack_vertices(quantized, kVertices, 8),
             {{"mode", "ATTRIBUTES"}, {"count", kVertices}, {"byteStride", 8}});
    compress(file, 1, pack_triangles(grid_indices()),
             {{"mode", "TRIANGLES"}, {"count", grid_indices().size()}, {"byteStride", 2}});
    const GltfRead read = read_gltf_text(packed_text(file));
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(read.mesh.positions.back(), (Point{kSide - 1, kSide - 1, 5}));
    EXPECT_EQ(read.mesh.triangles.size(), grid_indices().size() / 3);
}

TEST(GltfMeshopt, FiltersAreUndone) {
    // Exponential: the upper byte of a word is the exponent of the lower three: m * 2^e.
    GltfBuilder file = plain_grid();
    std::vector<uint32_t> words;
    for (const float value : grid_positions()) {
        const auto mantissa = static_cast<int32_t>(std::lround(value * 1024));
        words.push_back((static_cast<uint32_t>(mantissa) & 0xFFFFFFU) | (static_cast<uint32_t>(-10) << 24));
    }
    compress(file, 0, pack_vertices(words, kVertices, 12),
             {{"mode", "ATTRIBUTES"}, {"count", kVertices}, {"byteStride", 12}, {"filter", "EXPONENTIAL"}});
    const GltfRead exponential = read_gltf_text(packed_text(file));
    ASSERT_TRUE(exponential.ok) << exponential.message;
    expect_near_grid(exponential.mesh);

    // Quaternions of instances: each is a turn by 90 degrees about z. Five, which is no multiple of a vector's width.
    GltfBuilder turned = test::tetrahedron();
    std::vector<float> quaternions;
    for (int i = 0; i < 5; ++i) {
        for (const double value : {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)}) {
            quaternions.push_back(static_cast<float>(value));
        }
    }
    std::vector<uint64_t> filtered(5);
    meshopt_encodeFilterQuat(filtered.data(), 5, 8, 16, quaternions.data());
    const size_t rotation = turned.accessor("VEC4", std::vector<int16_t>(20));
    turned.root["accessors"][rotation]["normalized"] = true;
    turned.node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"ROTATION", rotation}};
    compress(turned, turned.root["accessors"][rotation]["bufferView"], pack_vertices(filtered, 5, 8),
             {{"mode", "ATTRIBUTES"}, {"count", 5}, {"byteStride", 8}, {"filter", "QUATERNION"}});
    const GltfRead quaternion = read_gltf_text(packed_text(turned));
    ASSERT_TRUE(quaternion.ok) << quaternion.message;
    ASSERT_EQ(quaternion.mesh.positions.size(), 20U);
    for (size_t i = 1; i < 20; i += 4) {
        EXPECT_NEAR(quaternion.mesh.positions[i][0], 0, 1e-3);
        EXPECT_NEAR(quaternion.mesh.positions[i][1], 1, 1e-3);
    }

    // Octahedral, on a stream of five vectors: only that it is taken, since gim reads no normals.
    GltfBuilder octahedral = test::tetrahedron();
    const std::vector<float> up = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::vector<uint32_t> octants(4);
    meshopt_encodeFilterOct(octants.data(), 4, 4, 8, up.data());
    octahedral.attribute("COLOR_0", octahedral.accessor("VEC4", std::vector<int8_t>(16)));
    octahedral.root["accessors"].back()["normalized"] = true;
    compress(octahedral, octahedral.root["accessors"].back()["bufferView"], pack_vertices(octants, 4, 4),
             {{"mode", "ATTRIBUTES"}, {"count", 4}, {"byteStride", 4}, {"filter", "OCTAHEDRAL"}});
    const GltfRead blue = read_gltf_text(packed_text(octahedral));
    ASSERT_TRUE(blue.ok) << blue.message;
    ASSERT_FALSE(blue.mesh.appearance.corner_colors.empty()) << blue.all_warnings;
    EXPECT_EQ(blue.mesh.appearance.corner_colors[0][0], (std::array<float, 3>{0, 0, 1}));
}

TEST(GltfMeshopt, PlainBytesStandInForWhatCannotBeDecoded) {
    GltfBuilder file = meshopt_file();
    position_packing(file)["mode"] = "NEWER";
    EXPECT_TRUE(says(read_gltf_text(packed_text(file)).message, "NEWER"));
    file.root["bufferViews"][0]["buffer"] = 0;  // where the uncompressed positions still are
    const GltfRead read = read_gltf_text(packed_text(file));
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(surface(read.mesh), grid_surface());
}

TEST(GltfMeshopt, WhatCannotBeDecodedIsNamed) {
    for (const auto& [key, value, word] :
         std::vector<std::tuple<std::string, Json, std::string>>{{"mode", "TRIANGLE", "TRIANGLE"},
                                                                 {"mode", nullptr, "mode"},
                                                                 {"mode", "TRIANGLES", "byteStride"},
                                                                 {"filter", "COLOR", "COLOR"},
                                                                 {"filter", "OCTAHEDRAL", "OCTAHEDRAL"},
                                                                 {"filter", "QUATERNION", "QUATERNION"},
                                                                 {"byteStride", 0, "byteStride"},
                                                                 {"byteStride", 13, "byteStride"},
                                                                 {"byteStride", 260, "byteStride"},
                                                                 {"count", 4000000000U, "more elements"},
                                                                 {"count", uint64_t{1} << 62, "more elements"},
                                                                 {"count", 200, "damaged"},
                                                                 {"byteLength", 20, "damaged"},
                                                                 {"byteLength", 10, "more elements"},
                                                                 {"byteLength", 0, "more elements"},
                                                                 {"byteOffset", 1U << 31, "more elements"},
                                                                 {"buffer", 1, "no data"}}) {
        GltfBuilder file = meshopt_file();
        position_packing(file)[key] = value;
        const GltfRead read = read_gltf_text(packed_text(file));
        EXPECT_FALSE(read.ok) << key << value;
        EXPECT_TRUE(says(read.message, word)) << key << value << read.message;
    }
    GltfBuilder newer = plain_grid();
    std::vector<uint8_t> packed = pack_vertices(grid_positions(), kVertices, 12);
    packed[0] = 0xa1;
    compress(newer, 0, packed, {{"mode", "ATTRIBUTES"}, {"count", kVertices}, {"byteStride", 12}});
    EXPECT_TRUE(says(read_gltf_text(packed_text(newer)).message, "version 1 of the vertex codec"))
        << read_gltf_text(packed_text(newer)).message;
}

TEST(GltfMeshopt, SpoiltBytesEndWithAMeshOrAMessage) {
    const auto spoil_stream = [](const std::vector<uint8_t>& packed, size_t view, const Json& layout) {
        spoil(packed, [&](const std::vector<uint8_t>& bytes) {
            GltfBuilder file = plain_grid();
            compress(file, view, bytes, layout);
            const GltfRead read = read_gltf_text(packed_text(file), "", uint64_t{64} << 20);
            if (!read.ok) {
                EXPECT_FALSE(read.message.empty());
            }
        });
    };
    const size_t indices = grid_indices().size();
    spoil_stream(pack_vertices(grid_positions(), kVertices, 12), 0,
                 {{"mode", "ATTRIBUTES"}, {"count", kVertices}, {"byteStride", 12}, {"filter", "EXPONENTIAL"}});
    spoil_stream(pack_triangles(grid_indices()), 1, {{"mode", "TRIANGLES"}, {"count", indices}, {"byteStride", 4}});
    spoil_stream(pack_sequence(grid_indices()), 1, {{"mode", "INDICES"}, {"count", indices}, {"byteStride", 4}});
}

}  // namespace
}  // namespace gim
