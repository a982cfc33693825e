// gim encode and gim decode with GLB files, as users call them.
#include <gtest/gtest.h>

#include "tests/tools/glb_scene.h"
#include "tests/tools/program.h"

namespace gim {
namespace {

using test::gim;
using test::Json;
using test::Outcome;
using test::says;
using test::TemporaryFolder;

// Options that make an encoding quick.
std::vector<std::string> quick_encode(const std::string& from, const std::string& to) {
    return {"encode", from, to, "--layout", "gim", "--size", "33", "--threads", "2"};
}

class GlbCommands : public testing::Test {
  protected:
    void SetUp() override { test::save(folder_.file("scene.gltf"), test::make_scene().text()); }

    Outcome run(std::vector<std::string> arguments, const std::vector<std::string>& more = {}) const {
        arguments.insert(arguments.end(), more.begin(), more.end());
        return gim(std::move(arguments));
    }
    std::string file(const std::string& name) const { return folder_.file(name); }
    const TemporaryFolder& folder() const { return folder_; }

  private:
    TemporaryFolder folder_;
};

TEST_F(GlbCommands, EncodeAndDecodeTellWhatTheyDo) {
    const Outcome encoded = run(quick_encode(file("scene.gltf"), file("out.glb")), {"--json", file("report.json")});
    EXPECT_EQ(encoded.status, 0) << encoded.err;
    EXPECT_TRUE(says(encoded.out, "ball")) << encoded.out;
    EXPECT_TRUE(says(encoded.out, "as it was"));
    EXPECT_TRUE(says(encoded.err, "warning: mesh 1 (skinned) stays as it is")) << encoded.err;
    const Json report = Json::parse(test::load_text(file("report.json")));
    EXPECT_EQ(report["meshes"].size(), 4u);
    EXPECT_EQ(report["file_bytes"], test::load_text(file("out.glb")).size());
    EXPECT_EQ(report["meshes"][0]["carried"], true);

    const Outcome decoded = run({"decode", file("out.glb"), file("back.glb"), "--level", "1"});
    EXPECT_EQ(decoded.status, 0) << decoded.err;
    EXPECT_EQ(run({"encode", file("back.glb"), file("all.gim"), "--size", "17", "--quiet"}).status, 0);
}

TEST_F(GlbCommands, TheFallbackLiesBesideTheFile) {
    const Outcome encoded = run(quick_encode(file("scene.gltf"), file("two words.glb")), {"--fallback"});
    EXPECT_EQ(encoded.status, 0) << encoded.err;
    EXPECT_EQ(folder().names(), (std::vector<std::string>{"scene.gltf", "two words.fallback.bin", "two words.glb"}));
    EXPECT_TRUE(says(test::load_text(file("two words.glb")), "two%20words.fallback.bin"));
    EXPECT_EQ(run({"compare", file("two words.glb"), file("scene.gltf"), "--samples", "2000"}).status, 0);
}

TEST_F(GlbCommands, WhatDoesNotFitIsRefused) {
    test::save(file("mesh.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto refused = [&](const std::vector<std::string>& arguments, const char* word) {
        const Outcome outcome = gim(arguments);
        EXPECT_EQ(outcome.status, 1);
        EXPECT_TRUE(says(outcome.err, word)) << outcome.err;
    };
    refused({"encode", file("mesh.obj"), file("out.glb")}, "glTF");
    refused({"encode", file("scene.gltf"), file("out.glb"), "--layout", "mcgim"}, "mcgim");
    refused({"encode", file("scene.gltf"), file("out.glb"), "--normals", "65"}, "--normals");
    refused({"encode", file("scene.gltf"), file("out.glb"), "--debug-dir", file("states")}, "--debug-dir");
    refused({"encode", file("scene.gltf"), file("out.gim"), "--fallback"}, "--fallback");
    refused({"decode", file("scene.gltf"), file("out.ply")}, ".glb");
    refused({"decode", file("scene.gltf"), file("out.glb"), "--fused"}, "--level");
    EXPECT_EQ(folder().names(), (std::vector<std::string>{"mesh.obj", "scene.gltf"}));
}

}  // namespace
}  // namespace gim
