// gim bench-scene: scenes are read with care, levels are chosen within error and budget, frames are drawn.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gim/emboss.h"
#include "tests/tools/program.h"
#include "tools/file.h"
#include "tools/scene/scene_painter.h"
#include "tools/scene/scene_run.h"

namespace gim {
namespace {

using nlohmann::json;

// A closed surface of tiles, beside the tests that draw.
const std::string kMesh = std::string(GIM_SOURCE_DIR) + "/tests/gpu/models/limbs-tiles.gim";

json scene_of(uint32_t columns, uint32_t rows) {
    return {{"meshes", {kMesh}},
            {"grid", {{"columns", columns}, {"rows", rows}, {"spacing", 1.5}, {"size", 1}}},
            {"camera", {{{"eye", {0, -40, 5}}, {"target", {0, 0, 0}}}, {{"eye", {0, -3, 1}}, {"target", {0, 0, 0.5}}}}},
            {"frames", 4},
            {"width", 192},
            {"height", 128},
            {"pixel_error", 0.2},
            {"instance_triangles", 4000}};
}

Scene read(const json& text) {
    const Result<Scene> scene = read_scene(text.dump(), "/");
    EXPECT_TRUE(scene.ok()) << scene.error().message;
    return scene.ok() ? scene.value() : Scene{};
}

TEST(Scene, AGridHasItsInstancesAndTheCameraItsPath) {
    const Scene scene = read(scene_of(3, 2));
    ASSERT_EQ(scene.instances.size(), 6u);
    EXPECT_EQ(scene.instances[0].position, (std::array<double, 3>{-1.5, -0.75, 0.5}));
    EXPECT_EQ(scene.camera(0).eye[1], -40);
    EXPECT_EQ(scene.camera(3).eye[1], -3);
    EXPECT_LT(scene.camera(1).eye[1], scene.camera(2).eye[1]);
}

// The place where the eye is in the space of the mesh is the one that the matrix takes to the eye.
TEST(Scene, PlacementsGoBothWays) {
    std::vector<SceneSurface> surfaces;
    surfaces.push_back(std::move(SceneSurface::read(kMesh).value()));
    for (const bool is_y_up : {false, true}) {
        const Placement p = placement_of({0, {1, 2, 3}, 2, 30}, surfaces[0], is_y_up);
        const std::array<double, 3> eye = {-4, 5, 0.5}, at = p.to_mesh(eye);
        const std::array<float, 16> m = p.matrix();
        for (size_t row = 0; row < 3; ++row)
            EXPECT_NEAR(m[row] * at[0] + m[4 + row] * at[1] + m[8 + row] * at[2] + m[12 + row], eye[row], 1e-5);
        EXPECT_EQ(m[is_y_up ? 6 : 10], static_cast<float>(p.scale));  // the axis that points up
    }
}

TEST(Scene, WhatIsWrongIsNamed) {
    const auto message_of = [](const std::function<void(json&)>& change) {
        json text = scene_of(2, 2);
        change(text);
        const Result<Scene> scene = read_scene(text.dump(), "/");
        return scene.ok() ? "" : scene.error().message;
    };
    EXPECT_EQ(message_of([](json&) {}), "");
    const std::vector<std::pair<std::string, std::function<void(json&)>>> wrong = {
        {"meshes", [](json& t) { t["meshes"] = json::array(); }},
        {"meshes", [](json& t) { t["meshes"] = {1}; }},
        {"grid", [](json& t) { t.erase("grid"); }},
        {"columns", [](json& t) { t["grid"]["columns"] = -1; }},
        {"camera", [](json& t) { t.erase("camera"); }},
        {"eye",
         [](json& t) {
             t["camera"][0]["eye"] = {1, 2};
         }},
        {"frames", [](json& t) { t["frames"] = 0; }},
        {"width", [](json& t) { t["width"] = "wide"; }},
        {"pixel_error", [](json& t) { t["pixel_error"] = 0; }},
        {"up",
         [](json& t) {
             t["meshes"] = {{{"file", kMesh}, {"up", "x"}}};
         }},
        {"gpu_refines", [](json& t) { t["gpu_refines"] = 1; }},
        {"mesh",
         [](json& t) {
             t["instances"] = {{{"mesh", 3}, {"position", {0, 0, 0}}}};
         }},
    };
    for (const auto& [word, change] : wrong) EXPECT_NE(message_of(change).find(word), std::string::npos) << word;
    EXPECT_FALSE(read_scene("{", "/").ok());
}

// What is near has more triangles than what is far; all together keep to the budget once it is known.
TEST(Scene, LevelsFollowTheDistanceAndTheBudget) {
    Scene scene = read(scene_of(4, 4));
    std::vector<SceneSurface> surfaces;
    surfaces.push_back(std::move(SceneSurface::read(kMesh).value()));
    ASSERT_EQ(surfaces[0].levels().size(), kDiscreteLevels);
    for (size_t l = 1; l < kDiscreteLevels; ++l) {
        EXPECT_LT(surfaces[0].levels()[l].triangles.size(), surfaces[0].levels()[l - 1].triangles.size());
        EXPECT_GT(surfaces[0].levels()[l].error, surfaces[0].levels()[l - 1].error);
    }
    const auto lod = SceneLod::create(scene, surfaces);
    ASSERT_TRUE(lod.ok()) << lod.error().message;
    FramePatches far, near, discrete, full;
    lod.value()->choose(LodWay::kAdaptive, scene.camera(0), &far);
    lod.value()->choose(LodWay::kAdaptive, scene.camera(3), &near);
    lod.value()->choose(LodWay::kDiscrete, scene.camera(3), &discrete);
    lod.value()->choose(LodWay::kFull, scene.camera(3), &full);
    EXPECT_GT(far.triangles, 0u);
    EXPECT_GT(near.triangles, 2 * far.triangles);
    EXPECT_LE(discrete.largest_error, scene.pixel_error);
    EXPECT_EQ(full.triangles, 16u * surfaces[0].finest_triangles());
    EXPECT_EQ(near.first.back(), near.patches.size());

    // Between what the bases have and what the error asks for.
    scene.most_triangles = static_cast<uint32_t>((near.triangles + far.triangles) / 2);
    for (int frame = 0; frame < 50; ++frame) lod.value()->choose(LodWay::kAdaptive, scene.camera(3), &near);
    EXPECT_LE(near.triangles, scene.most_triangles);
    EXPECT_GT(near.triangles, far.triangles);
    EXPECT_GT(near.largest_error, scene.pixel_error);
}

// Embossed files are drawn with their details, by both ways of drawing.
TEST(Scene, DetailsAreDrawn) {
    const test::TemporaryFolder folder;
    const Result<Bytes> file = read_file(kMesh);
    ASSERT_TRUE(file.ok());
    const SceneSurface plain = std::move(SceneSurface::read(kMesh).value());
    EmbossOptions options;
    options.at = plain.middle();
    options.size = 0.3 * plain.longest_side();
    options.depth = 0.1 * plain.longest_side();
    options.texel_exponent = 1;
    const Result<Embossed> embossed = emboss(file.value(), {32, 32, std::vector<float>(1024, 1.0f)}, options);
    ASSERT_TRUE(embossed.ok()) << embossed.error().message;
    const Bytes& bytes = embossed.value().bytes;
    test::save(folder.file("embossed.gim"), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    std::vector<SceneSurface> surfaces;
    surfaces.push_back(std::move(SceneSurface::read(folder.file("embossed.gim")).value()));
    EXPECT_TRUE(surfaces[0].has_details());
    EXPECT_GT(surfaces[0].shape().vertex_count, 3 * plain.shape().vertex_count);

    std::vector<size_t> covered;
    for (const bool tessellates : {false, true}) {
        Scene scene = read(scene_of(1, 1));
        scene.tessellates = tessellates;
        scene.instance_triangles = 200000;
        scene.pixel_error = 1;
        const auto painter = make_painter(scene, surfaces);
        if (!painter.ok()) GTEST_SKIP() << painter.error().message;
        const auto lod = SceneLod::create(scene, surfaces);
        ASSERT_TRUE(lod.ok()) << lod.error().message;
        FramePatches patches;
        lod.value()->choose(LodWay::kAdaptive, scene.camera(3), &patches);
        painter.value()->upload(*lod.value(), LodWay::kAdaptive, scene.camera(3), patches);
        ASSERT_TRUE(painter.value()->draw().ok());
        const std::vector<uint8_t> picture = painter.value()->picture();
        covered.push_back(0);
        for (size_t p = 0; p < picture.size(); p += 3) covered.back() += picture[p] != picture[0];
    }
    EXPECT_GT(covered[0], 500u);
    EXPECT_NEAR(double(covered[0]), double(covered[1]), 0.02 * double(covered[0]));
}

TEST(Scene, AnInstanceWithoutRoomIsNamed) {
    json text = scene_of(1, 1);
    text["instance_triangles"] = 2;
    SceneRun run;
    run.draws = false;
    const Result<SceneFigures> figures = run_scene(read(text), run);
    ASSERT_FALSE(figures.ok());
    EXPECT_NE(figures.error().message.find("instance 0"), std::string::npos);
}

// All three ways draw the same scene: most pixels have the same kind of colour, sky or surface.
TEST(Scene, FramesShowTheInstances) {
    if (!can_draw_scenes()) GTEST_SKIP() << "built without OpenGL";
    const Scene scene = read(scene_of(3, 3));
    std::vector<SceneSurface> surfaces;
    surfaces.push_back(std::move(SceneSurface::read(kMesh).value()));
    const auto painter = make_painter(scene, surfaces);
    if (!painter.ok()) GTEST_SKIP() << painter.error().message;
    const auto lod = SceneLod::create(scene, surfaces);
    ASSERT_TRUE(lod.ok());
    std::vector<std::vector<uint8_t>> pictures;
    for (const LodWay way : {LodWay::kFull, LodWay::kAdaptive, LodWay::kDiscrete}) {
        FramePatches patches;
        lod.value()->choose(way, scene.camera(3), &patches);
        painter.value()->upload(*lod.value(), way, scene.camera(3), patches);
        const Result<uint64_t> drawn = painter.value()->draw();
        ASSERT_TRUE(drawn.ok()) << drawn.error().message;
        EXPECT_GE(drawn.value(), patches.triangles);
        pictures.push_back(painter.value()->picture());
        ASSERT_EQ(pictures.back().size(), size_t{3} * scene.width * scene.height);
    }
    size_t surface = 0;
    const uint8_t sky = pictures[0][0];  // the corner
    for (size_t p = 0; p < pictures[0].size(); p += 3) surface += pictures[0][p] != sky;
    EXPECT_GT(surface, pictures[0].size() / 3 / 20);
    EXPECT_LT(surface, pictures[0].size() / 3 * 9 / 10);
    for (size_t way = 1; way < pictures.size(); ++way) {
        size_t differ = 0;
        for (size_t p = 0; p < pictures[0].size(); p += 3)
            differ += (pictures[0][p] != sky) != (pictures[way][p] != sky);
        EXPECT_LT(differ, surface / 10) << way;
    }
}

TEST(Scene, TheProgramWritesFiguresAndFrames) {
    const test::TemporaryFolder folder;
    test::save(folder.file("scene.json"), scene_of(2, 1).dump());
    const test::Outcome cpu =
        test::gim({"bench-scene", folder.file("scene.json"), "--no-draw", "--json", folder.file("cpu.json")});
    ASSERT_EQ(cpu.status, 0) << cpu.err;
    const json figures = json::parse(test::load_text(folder.file("cpu.json")));
    EXPECT_EQ(figures["instances"], 2);
    EXPECT_GT(figures["adaptive"]["triangles"]["mean"], 0);
    EXPECT_LT(figures["adaptive"]["triangles"]["mean"], figures["full"]["triangles"]["mean"]);
    EXPECT_NE(cpu.out.find("4 levels"), std::string::npos);

    const test::Outcome drawn = test::gim({"bench-scene", folder.file("scene.json"), "--no-compare", "--frames",
                                           folder.file("frames"), "--json", folder.file("gpu.json")});
    if (drawn.status != 0) GTEST_SKIP() << drawn.err;
    EXPECT_TRUE(std::filesystem::exists(folder.file("frames/frame-00003.png")));
    EXPECT_FALSE(json::parse(test::load_text(folder.file("gpu.json")))["renderer"].is_null());

    json missing = scene_of(1, 1);
    missing["meshes"] = {"none.gim"};
    test::save(folder.file("missing.json"), missing.dump());
    EXPECT_EQ(test::gim({"bench-scene", folder.file("missing.json"), "--no-draw"}).status, 1);
}

}  // namespace
}  // namespace gim
