// The glTF reader on containers: GLB chunks, URIs, damaged JSON.
#include <gtest/gtest.h>

#include "tests/tools/gltf_builder.h"
#include "tests/tools/test_files.h"

namespace gim {
namespace {

using test::GltfBuilder;
using test::GltfRead;
using test::Json;
using test::read_gltf_file;
using test::read_gltf_text;
using test::says;
using test::tetrahedron;

std::string u32(uint32_t value) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &value, 4);
    return bytes;
}

struct Chunk {
    std::string type, content;
};

std::string glb(const std::vector<Chunk>& chunks, uint32_t version = 2) {
    std::string body;
    for (const Chunk& chunk : chunks)
        body += u32(static_cast<uint32_t>(chunk.content.size())) + chunk.type + chunk.content;
    return "glTF" + u32(version) + u32(static_cast<uint32_t>(12 + body.size())) + body;
}

const std::string kBin("BIN\0", 4);

// The JSON of a tetrahedron whose buffer is the binary chunk.
std::string chunk_json(const GltfBuilder& file) {
    Json root = file.root;
    root["buffers"] = Json::array({{{"byteLength", file.bytes().size()}}});
    return root.dump();
}

TEST(GltfContainer, ChunksOfAnyKindLengthAndPaddingAreRead) {
    const GltfBuilder file = tetrahedron();
    const std::string json = chunk_json(file);
    for (const std::string& content :
         {glb({{"JSON", json}, {kBin, file.bytes()}}), glb({{"JSON", json + "\0\0"}, {kBin, file.bytes() + "pad"}}),
          glb({{"JSON", json + std::string(3, '\0')}, {"WHAT", "?"}, {kBin, file.bytes()}, {kBin, "second"}}),
          glb({{"JSON", json}, {kBin, file.bytes()}}) + "trailing bytes"}) {
        const GltfRead read = read_gltf_text(content);
        ASSERT_TRUE(read.ok) << read.message;
        EXPECT_EQ(read.mesh.triangles.size(), 4U);
    }
    EXPECT_TRUE(says(read_gltf_text(glb({{"JSON", json}})).message, "no data"));
    EXPECT_TRUE(says(read_gltf_text(glb({{kBin, file.bytes()}})).message, "no JSON chunk"));
    EXPECT_TRUE(says(read_gltf_text(glb({{"JSON", json}}, 1)).message, "glTF 1.0; only 2.0 is read"));
    EXPECT_TRUE(says(read_gltf_text(glb({{"JSON", json}}, 3)).message, "version 3"));
}

TEST(GltfContainer, EveryTruncationIsRefused) {
    const GltfBuilder file = tetrahedron();
    const std::string whole = glb({{"JSON", chunk_json(file)}, {kBin, file.bytes()}});
    for (size_t size = 4; size < whole.size(); ++size) {
        EXPECT_FALSE(read_gltf_text(whole.substr(0, size)).ok) << "cut at " << size;
    }
}

TEST(GltfContainer, DamagedJsonIsNamedShortly) {
    const std::string text = tetrahedron().text();
    for (size_t size = 0; size + 1 < text.size(); size += 7) {
        const GltfRead read = read_gltf_text(text.substr(0, size));
        EXPECT_FALSE(read.ok) << "cut at " << size;
        EXPECT_LT(read.message.size(), 400U);
    }
    EXPECT_TRUE(says(read_gltf_text("{\"asset\"").message, "JSON is damaged"));
    EXPECT_FALSE(read_gltf_text("[]").ok);
    EXPECT_FALSE(read_gltf_text(std::string(1000000, '[')).ok);
    EXPECT_TRUE(says(read_gltf_text(std::string(1000000, '['), "", 10000000).message, "--max-memory"));
}

// Members of the wrong type, everywhere.
TEST(GltfContainer, WrongTypesAreRefusedOrIgnored) {
    const Json good = Json::parse(tetrahedron().text());
    const Json flat = good.flatten();
    for (const auto& [path, unused] : flat.items()) {
        for (const Json& value : {Json(nullptr), Json("x"), Json(-1), Json(1e300), Json(true), Json(Json::object()),
                                  Json(Json::array()), Json(uint64_t{1} << 63)}) {
            Json changed = good;
            changed[Json::json_pointer(path)] = value;
            const GltfRead read = read_gltf_text(changed.dump());
            if (!read.ok) {
                EXPECT_TRUE(says(read.message, "(as glTF)")) << path << " " << value << " " << read.message;
            }
        }
    }
}

// ---- URIs -----------------------------------------------------------------------------------------------------------

class GltfUri : public ::testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(folder_.file("in"));
        for (const std::string name : {"plain.bin", "with blank.bin", "100%.bin", "in/deep.bin", "\xC3\xA4.bin"}) {
            test::save(folder_.file(name), file_.bytes());
        }
    }
    // Reads a file whose buffer has this URI, from the subfolder `in` or from the folder.
    GltfRead read(const std::string& uri, bool from_in = false, uint64_t memory = uint64_t{1} << 30) {
        GltfBuilder file = file_;
        file.root["buffers"] = Json::array({{{"byteLength", file.bytes().size()}, {"uri", uri}}});
        return read_gltf_text(file.text(), from_in ? folder_.file("in") : folder_.path(), memory);
    }

    GltfBuilder file_ = tetrahedron();
    test::TemporaryFolder folder_;
};

TEST_F(GltfUri, NamesAreReadEncodedOrNot) {
    for (const std::string uri : {"plain.bin", "./plain.bin", "with%20blank.bin", "with blank.bin", "100%.bin",
                                  "100%25.bin", "in/deep.bin", "in\\deep.bin", "%C3%A4.bin", "\xC3\xA4.bin"}) {
        EXPECT_TRUE(read(uri).ok) << uri << read(uri).message;
    }
    EXPECT_TRUE(read("../with%20blank.bin", true).ok) << "peers read files outside of the folder too";
}

TEST_F(GltfUri, DataIsReadInEveryDialect) {
    const std::string digits = test::base64(file_.bytes());
    std::string percent;
    for (const char c : file_.bytes()) {
        const char* const kHex = "0123456789abcdef";
        percent += std::string("%") + kHex[static_cast<uint8_t>(c) >> 4] + kHex[static_cast<uint8_t>(c) & 15];
    }
    std::string unpadded = digits;
    while (unpadded.ends_with('=')) unpadded.pop_back();
    for (const std::string& uri : {"data:application/gltf-buffer;base64," + digits, "data:;base64," + digits,
                                   "DATA:;base64," + unpadded, "data:application/octet-stream," + percent,
                                   "data:;base64," + digits.substr(0, 8) + "\n" + digits.substr(8)}) {
        EXPECT_TRUE(read(uri).ok) << uri.substr(0, 40) << read(uri).message;
    }
}

TEST_F(GltfUri, WhatCannotBeReadSaysWhy) {
    for (const auto& [uri, word] :
         std::vector<std::pair<std::string, std::string>>{{"", "empty"},
                                                          {"none.bin", "no such file"},
                                                          {"%!QAA", "hexadecimal"},
                                                          {"%", "hexadecimal"},
                                                          {"in", "no such file"},
                                                          {"../../../../../../dev/zero", "no such file"},
                                                          {"/etc/passwd", "absolute"},
                                                          {"%2Fetc/passwd", "absolute"},
                                                          {"C:\\mesh.bin", "absolute"},
                                                          {"https://example.org/mesh.bin", "address"},
                                                          {"file:///etc/passwd", "address"},
                                                          {"data:application/octet-stream;base64", "comma"},
                                                          {"data:;base64,A*B", "base64"},
                                                          {"data:;base64,AA==AA", "base64"},
                                                          {"data:,%4", "hexadecimal"},
                                                          {"data:,", "beyond its buffer"},
                                                          {"plain.bin%00.bin", "zero byte"}}) {
        const GltfRead result = read(uri);
        EXPECT_FALSE(result.ok) << uri;
        EXPECT_TRUE(says(result.message, word)) << uri << ": " << result.message;
    }
    std::filesystem::resize_file(folder_.file("plain.bin"), uintmax_t{1} << 31);
    EXPECT_TRUE(says(read("plain.bin").message, "memory limit")) << "a sparse file of 2 GB is not read";
}

TEST_F(GltfUri, BuffersThatNothingUsesAreNotRead) {
    GltfBuilder file = file_;
    file.root["buffers"] = Json::array({{{"byteLength", file.bytes().size()}, {"uri", "plain.bin"}},
                                        {{"byteLength", 100}, {"uri", "animation that was not copied.bin"}}});
    EXPECT_TRUE(read_gltf_text(file.text(), folder_.path()).ok);
}

TEST_F(GltfUri, AccessorsMayLieInSeveralBuffers) {
    GltfBuilder file = file_;
    file.root["buffers"] = Json::array({{{"byteLength", file.bytes().size()}, {"uri", "plain.bin"}},
                                        {{"byteLength", file.bytes().size()}, {"uri", "in/deep.bin"}}});
    file.root["bufferViews"][1]["buffer"] = 1;
    EXPECT_TRUE(read_gltf_text(file.text(), folder_.path()).ok);
    file.root["bufferViews"][1]["buffer"] = 2;
    EXPECT_FALSE(read_gltf_text(file.text(), folder_.path()).ok);
}

}  // namespace
}  // namespace gim
