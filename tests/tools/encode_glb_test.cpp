// gim encode and decode of glTF files with their scenes.
#include "tools/encode_glb.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/tools/glb_scene.h"
#include "tests/tools/test_files.h"
#include "tools/glb_file.h"
#include "tools/gltf_primitive.h"
#include "tools/mesh_read.h"

namespace gim {
namespace {

using test::as_text;
using test::decode_bytes;
using test::encode_text;
using test::Json;
using test::json_of;
using test::Made;
using test::quick;
using test::says;

// Without what the two kinds of file differ in.
Json scene_of(Json root) {
    for (const char* list : {"accessors", "bufferViews", "buffers", "extensionsUsed", "extensionsRequired"})
        root.erase(list);
    for (Json& animation : root["animations"]) animation.erase("samplers");
    for (Json& mesh : root["meshes"])
        for (Json& primitive : mesh["primitives"])
            for (const char* key : {"attributes", "indices", "mode", "targets", "extensions"}) primitive.erase(key);
    return root;
}

// Primitives of a plain mesh, joined where positions are equal.
TriangleMesh joined(const Bytes& glb, size_t mesh) {
    const std::string text = as_text(glb);
    ReadContext context;
    gltf::File file(text, context);
    gltf::DracoMeshes draco;
    const std::vector<double> weights;
    TriangleMesh all;
    for (const Json& object : file.root()["meshes"][mesh]["primitives"]) {
        gltf::Primitive primitive(file, draco, object, weights);
        const auto base = static_cast<uint32_t>(all.positions.size());
        const gltf::MorphedColumn positions = primitive.attribute("POSITION", 3);
        for (uint64_t row = 0; row < positions.base.count; ++row)
            all.positions.push_back({positions.at(row, 0), positions.at(row, 1), positions.at(row, 2)});
        const std::vector<uint32_t> corners = primitive.corners();
        for (size_t i = 0; i < corners.size(); i += 3)
            all.triangles.push_back({base + corners[i], base + corners[i + 1], base + corners[i + 2]});
    }
    return weld_equal_positions(all);
}

class EncodeGlb : public testing::Test {
  protected:
    static void SetUpTestSuite() { made_ = new Made(encode_text(test::make_scene().text(), quick())); }
    static void TearDownTestSuite() { delete std::exchange(made_, nullptr); }
    static const Made& made() { return *made_; }

  private:
    static Made* made_;
};
Made* EncodeGlb::made_ = nullptr;

TEST_F(EncodeGlb, TheSceneStays) {
    const Json before = test::make_scene().root, after = json_of(made().glb.glb);
    EXPECT_EQ(scene_of(before), scene_of(after));
    EXPECT_EQ(scene_of(before), scene_of(json_of(decode_bytes(made().glb.glb))));
    EXPECT_EQ(after["extensionsUsed"], Json({"KHR_lights_punctual", "EXT_gim_geometry"}));
    EXPECT_EQ(after["extensionsRequired"], Json({"EXT_gim_geometry"}));
}

TEST_F(EncodeGlb, ItsMeshIsOneGimWithLabels) {
    const Json root = json_of(made().glb.glb);
    const Json& primitives = root["meshes"][0]["primitives"];
    ASSERT_EQ(primitives.size(), 2u);
    const Json first = primitives[0]["extensions"]["EXT_gim_geometry"],
               second = primitives[1]["extensions"]["EXT_gim_geometry"];
    EXPECT_EQ(first["bufferView"], second["bufferView"]);
    EXPECT_EQ(first["label"], 0);
    EXPECT_EQ(second["label"], 1);
    const Json& view = root["bufferViews"][first["bufferView"].get<size_t>()];
    EXPECT_EQ(view["byteOffset"], 0);
    EXPECT_EQ(view["byteLength"], made().glb.meshes[0].gim_bytes);
    for (const Json& primitive : primitives) {
        EXPECT_EQ(primitive["attributes"].size(), 2u);
        for (const char* name : {"POSITION", "NORMAL"})
            EXPECT_FALSE(root["accessors"][primitive["attributes"][name].get<size_t>()].contains("bufferView"));
    }
    EXPECT_TRUE(made().glb.meshes[0].is_carried);
    EXPECT_GT(made().glb.meshes[0].psnr, 50);
}

TEST_F(EncodeGlb, OtherMeshesStayWithAWarning) {
    const Json before = test::make_scene().root, after = json_of(made().glb.glb);
    for (size_t mesh = 1; mesh < 4; ++mesh) {
        EXPECT_FALSE(made().glb.meshes[mesh].is_carried);
        EXPECT_EQ(before["meshes"][mesh]["primitives"][0]["attributes"].size(),
                  after["meshes"][mesh]["primitives"][0]["attributes"].size());
    }
    EXPECT_TRUE(says(made().warnings, "a skin moves it")) << made().warnings;
    EXPECT_TRUE(says(made().warnings, "morph targets"));
    EXPECT_TRUE(says(made().warnings, "points"));
    EXPECT_EQ(joined(made().glb.glb, 1).triangles.size(), 4u);
}

TEST_F(EncodeGlb, TheOldArraysAreGone) {
    // The sphere has more than 1,500 vertices of 24 bytes.
    EXPECT_LT(made().glb.glb.size(), 12000u);
    EXPECT_GT(made().glb.meshes[0].plain_bytes, 50000u);
}

TEST_F(EncodeGlb, MaterialsMeetWithoutCracksAtEveryLevel) {
    size_t triangles = SIZE_MAX;
    for (uint32_t level = 0; level < 2; ++level) {
        const TriangleMesh mesh = joined(decode_bytes(made().glb.glb, level), 0);
        EXPECT_TRUE(summarize_topology(mesh).watertight) << level;
        EXPECT_LT(mesh.triangles.size(), triangles);
        triangles = mesh.triangles.size();
    }
}

TEST_F(EncodeGlb, MaterialsStayWhereTheyWere) {
    const Bytes plain = decode_bytes(made().glb.glb);
    const Json root = json_of(plain);
    for (const size_t p : {0, 1}) {
        const Json& primitive = root["meshes"][0]["primitives"][p];
        const Json& bounds = root["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
        // A cell of the border reaches over the middle by its own size at most.
        EXPECT_LT(bounds["max"][0].get<double>(), p == 0 ? 0.2 : 1.1);
        EXPECT_GT(bounds["min"][0].get<double>(), p == 0 ? -1.1 : -0.2);
    }
}

TEST_F(EncodeGlb, AccessorsDescribeTheDecodedArrays) {
    const Json told = json_of(made().glb.glb), decoded = json_of(decode_bytes(made().glb.glb));
    EXPECT_FALSE(decoded.contains("extensionsRequired"));
    EXPECT_EQ(decoded["extensionsUsed"], Json({"KHR_lights_punctual"}));
    for (size_t p = 0; p < 2; ++p) {
        const auto accessor = [p](const Json& root, const char* name) {
            const Json& primitive = root["meshes"][0]["primitives"][p];
            const Json& index = std::string(name) == "indices" ? primitive["indices"] : primitive["attributes"][name];
            Json found = root["accessors"][index.get<size_t>()];
            found.erase("bufferView");
            return found;
        };
        for (const char* name : {"POSITION", "NORMAL", "indices"})
            EXPECT_EQ(accessor(told, name), accessor(decoded, name)) << name;
    }
}

TEST_F(EncodeGlb, TheSameInputGivesTheSameBytes) {
    EXPECT_EQ(encode_text(test::make_scene().text(), quick()).glb.glb, made().glb.glb);
}

TEST_F(EncodeGlb, ReadersWithoutTheExtensionTakeTheFallback) {
    const test::TemporaryFolder folder;
    GlbEncodeOptions options = quick();
    options.fallback_uri = "arrays.bin";
    const Made made = encode_text(test::make_scene().text(), options);
    ASSERT_FALSE(made.glb.fallback.empty());
    test::save(folder.file("arrays.bin"), as_text(made.glb.fallback));
    const Json root = json_of(made.glb.glb);
    EXPECT_FALSE(root.contains("extensionsRequired"));
    EXPECT_EQ(root["buffers"][1]["uri"], "arrays.bin");
    const auto read = [&](const Bytes& bytes) {
        ReadContext context{folder.path()};
        auto mesh = read_mesh(bytes, MeshFormat::kGltf, context);
        EXPECT_TRUE(mesh.ok()) << mesh.error().message;
        return mesh.ok() ? mesh.value() : TriangleMesh{};
    };
    const TriangleMesh fallback = read(made.glb.glb), decoded = read(decode_bytes(made.glb.glb));
    EXPECT_GT(fallback.positions.size(), 1000u);
    EXPECT_EQ(fallback.positions, decoded.positions);
    EXPECT_EQ(fallback.triangles, decoded.triangles);
}

TEST_F(EncodeGlb, ReadersOfMeshesSayWhatToDo) {
    ReadContext context;
    const auto mesh = read_mesh(made().glb.glb, MeshFormat::kGltf, context);
    ASSERT_FALSE(mesh.ok());
    EXPECT_TRUE(says(mesh.error().message, "gim decode")) << mesh.error().message;
}

TEST_F(EncodeGlb, DamagedFilesAreRefused) {
    const auto decode_changed = [&](const std::function<void(Json&)>& change, const char* word) {
        std::string text = as_text(made().glb.glb);
        uint32_t size = 0;
        std::memcpy(&size, text.data() + 12, 4);
        Json root = Json::parse(text.substr(20, size));
        change(root["meshes"][0]["primitives"][0]);
        const std::string json = root.dump();
        const Result<Bytes> changed = glb_bytes(json, Bytes(text.begin() + 28 + size, text.end()));
        ASSERT_TRUE(changed.ok());
        text = as_text(changed.value());
        ReadContext context;
        const auto decoded = decode_glb(text, context, 0);
        ASSERT_FALSE(decoded.ok());
        EXPECT_TRUE(says(decoded.error().message, word)) << decoded.error().message;
    };
    const auto extension = [](Json& primitive) -> Json& { return primitive["extensions"]["EXT_gim_geometry"]; };
    decode_changed([&](Json& p) { extension(p)["bufferView"] = 99; }, "bufferViews");
    decode_changed([&](Json& p) { extension(p).erase("bufferView"); }, "buffer view");
    decode_changed([&](Json& p) { extension(p)["label"] = 256; }, "label");
    decode_changed([&](Json& p) { extension(p) = {{"bufferView", 1}}; }, "not a .gim");
    decode_changed([&](Json& p) { extension(p)["places"] = {1, 2}; }, "places");
}

TEST_F(EncodeGlb, AMeshThatIsSmallerThanItsGimStays) {
    const Made small = encode_text(test::tetrahedron().text(), quick());
    EXPECT_FALSE(small.glb.meshes[0].is_carried);
    EXPECT_TRUE(says(small.warnings, "its arrays only")) << small.warnings;
    EXPECT_FALSE(json_of(small.glb.glb).contains("extensionsUsed"));
}

// The Khronos validator, where node and its package are there (npm ci in tests/gltf).
TEST_F(EncodeGlb, TheValidatorFindsNoErrors) {
    const std::string folder = std::string(GIM_SOURCE_DIR) + "/tests/gltf";
    if (!std::filesystem::exists(folder + "/node_modules/gltf-validator"))
        GTEST_SKIP() << "no gltf-validator; run npm ci in tests/gltf";
    const test::TemporaryFolder files;
    GlbEncodeOptions options = quick();
    options.fallback_uri = "arrays.bin";
    const Made with_fallback = encode_text(test::make_scene().text(), options);
    test::save(files.file("gim.glb"), as_text(made().glb.glb));
    test::save(files.file("plain.glb"), as_text(decode_bytes(made().glb.glb)));
    test::save(files.file("coarse.glb"), as_text(decode_bytes(made().glb.glb, 2)));
    test::save(files.file("both.glb"), as_text(with_fallback.glb.glb));
    test::save(files.file("arrays.bin"), as_text(with_fallback.glb.fallback));
    std::string command = "node '" + folder + "/validate.mjs'";
    for (const char* name : {"gim.glb", "plain.glb", "coarse.glb", "both.glb"})
        command += " '" + files.file(name) + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace gim
