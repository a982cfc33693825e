// The glTF reader on files that are not compressed: accessors, nodes, morph targets, skins, colours, extensions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tools/gltf_builder.h"
#include "tools/stb.h"

namespace gim {
namespace {

using test::GltfBuilder;
using test::GltfRead;
using test::Json;
using test::read_gltf_file;
using test::read_gltf_text;
using test::says;
using test::tetrahedron;
using Point = std::array<double, 3>;
using Triangle = std::array<uint32_t, 3>;

void expect_point(const Point& point, const Point& right) {
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(point[k], right[k], 1e-6) << k;
}

// ---- accessors ------------------------------------------------------------------------------------------------------

TEST(GltfRead, PlainFileIsReadWithoutAWarning) {
    const GltfRead read = read_gltf_file(tetrahedron());
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(read.mesh.positions, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(read.mesh.triangles, (std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}));
    EXPECT_TRUE(read.warnings.empty()) << read.all_warnings;
}

TEST(GltfRead, SparseAccessorsReplaceRowsOfABufferOrOfZeros) {
    GltfBuilder file = tetrahedron();
    const size_t rows = file.view<uint16_t>({3});
    const size_t values = file.view<float>({0, 0, 2});
    Json& positions = file.root["accessors"][0];
    positions["sparse"] = {{"count", 1},
                           {"indices", {{"bufferView", rows}, {"componentType", 5123}}},
                           {"values", {{"bufferView", values}}}};
    const GltfRead with_base = read_gltf_file(file);
    ASSERT_TRUE(with_base.ok) << with_base.message;
    EXPECT_EQ(with_base.mesh.positions[1], (Point{1, 0, 0}));
    EXPECT_EQ(with_base.mesh.positions[3], (Point{0, 0, 2}));

    positions.erase("bufferView");
    const GltfRead zeros = read_gltf_file(file);
    ASSERT_TRUE(zeros.ok) << zeros.message;
    EXPECT_EQ(zeros.mesh.positions[1], (Point{0, 0, 0}));
    EXPECT_EQ(zeros.mesh.positions[3], (Point{0, 0, 2}));

    positions["count"] = 3;
    EXPECT_TRUE(says(read_gltf_file(file).message, "sparse index 3")) << read_gltf_file(file).message;
    positions["count"] = 4;
    positions["sparse"]["count"] = 2000000000;
    EXPECT_TRUE(says(read_gltf_file(file).message, "beyond its buffer")) << read_gltf_file(file).message;
}

TEST(GltfRead, CountsBeyondTheMemoryLimitAreRefused) {
    GltfBuilder file = tetrahedron();
    Json& positions = file.root["accessors"][0];
    positions.erase("bufferView");
    for (const uint64_t count : {uint64_t{4000000000}, uint64_t{1} << 60}) {
        positions["count"] = count;
        EXPECT_TRUE(says(read_gltf_file(file).message, "--max-memory")) << read_gltf_file(file).message;
    }
    EXPECT_TRUE(says(read_gltf_text(tetrahedron().text(), "", 1000).message, "--max-memory"));
}

template <class T>
void expect_quantized(double scale) {
    const T one = std::numeric_limits<T>::max();
    for (const bool normalized : {false, true}) {
        GltfBuilder file;
        file.attribute("POSITION", file.accessor<T>("VEC3", {0, 0, 0, one, 0, 0, 0, one, 0, 0, 0, one}));
        file.root["accessors"][0]["normalized"] = normalized;
        file.primitive()["indices"] = file.accessor<uint8_t>("SCALAR", {0, 2, 1, 0, 1, 3});
        file.use_extension("KHR_mesh_quantization");
        const GltfRead read = read_gltf_file(file);
        ASSERT_TRUE(read.ok) << read.message;
        EXPECT_DOUBLE_EQ(read.mesh.positions[1][0], normalized ? 1 : scale);
        EXPECT_TRUE(read.warnings.empty()) << read.all_warnings;
    }
}

TEST(GltfRead, QuantizedPositionsOfEveryTypeAreScaled) {
    expect_quantized<int8_t>(127);
    expect_quantized<uint8_t>(255);
    expect_quantized<int16_t>(32767);
    expect_quantized<uint16_t>(65535);
}

TEST(GltfRead, InterleavedRowsAndTypesAreChecked) {
    GltfBuilder file = tetrahedron();
    const std::vector<float> rows = {0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9, 0, 0, 1};  // the last row has no padding
    file.root["accessors"][0]["bufferView"] = file.view(rows);
    file.root["bufferViews"].back()["byteStride"] = 16;
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(read.mesh.positions[3], (Point{0, 0, 1}));

    for (const auto& [key, value, word] :
         std::vector<std::tuple<std::string, Json, std::string>>{{"type", "VEC2", "three numbers"},
                                                                 {"type", "MAT7", "MAT7"},
                                                                 {"componentType", 77, "77"},
                                                                 {"componentType", -1, "componentType"},
                                                                 {"count", -5, "count"},
                                                                 {"count", "four", "count"},
                                                                 {"count", 5, "beyond its buffer"},
                                                                 {"byteOffset", 1000000, "beyond its buffer"},
                                                                 {"bufferView", 99, "99"}}) {
        GltfBuilder bad = file;
        bad.root["accessors"][0][key] = value;
        EXPECT_TRUE(says(read_gltf_file(bad).message, word)) << read_gltf_file(bad).message;
    }
    GltfBuilder overlapping = file;
    overlapping.root["bufferViews"].back()["byteStride"] = 4;
    EXPECT_TRUE(says(read_gltf_file(overlapping).message, "byteStride"));
    GltfBuilder real_indices = tetrahedron();
    real_indices.primitive()["indices"] = 0;
    EXPECT_TRUE(says(read_gltf_file(real_indices).message, "no unsigned integers"));
}

// ---- primitives -----------------------------------------------------------------------------------------------------

TEST(GltfRead, VerticesThatNoTriangleUsesAreLeftOut) {
    GltfBuilder file = tetrahedron();
    file.primitive()["indices"] = file.accessor<uint8_t>("SCALAR", {1, 2, 3});
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(read.mesh.positions, (std::vector<Point>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(read.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(GltfRead, TheLargestIndexRestartsAStripUnlessItIsAVertex) {
    GltfBuilder file = tetrahedron();
    file.primitive()["mode"] = 5;
    file.primitive()["indices"] = file.accessor<uint8_t>("SCALAR", {0, 1, 2, 3, 255, 3, 2, 1, 255});
    const GltfRead restarted = read_gltf_file(file);
    ASSERT_TRUE(restarted.ok) << restarted.message;
    EXPECT_EQ(restarted.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {3, 2, 1}}));

    GltfBuilder large;
    std::vector<float> positions(size_t{256} * 3);
    positions[255 * 3] = 7;
    large.attribute("POSITION", large.accessor("VEC3", positions));
    large.primitive()["indices"] = large.accessor<uint8_t>("SCALAR", {0, 1, 255});
    const GltfRead vertex = read_gltf_file(large);
    ASSERT_TRUE(vertex.ok) << vertex.message;
    EXPECT_EQ(vertex.mesh.positions.back(), (Point{7, 0, 0}));

    file.primitive()["indices"] = file.accessor<uint8_t>("SCALAR", {0, 1, 4});
    EXPECT_TRUE(says(read_gltf_file(file).message, "an index is 4")) << read_gltf_file(file).message;
}

TEST(GltfRead, PointsLinesAndEmptyPrimitivesAreSkipped) {
    GltfBuilder file = tetrahedron();
    Json lines = file.primitive();
    lines["mode"] = 1;
    Json no_positions = {{"indices", 1}};
    GltfBuilder without = file;
    without.root["meshes"][0]["primitives"] = Json::array({lines, no_positions, Json::object()});
    EXPECT_TRUE(says(read_gltf_file(without).message, "no triangles")) << read_gltf_file(without).message;

    Json empty = file.primitive();
    empty["indices"] = file.add("accessors", {{"componentType", 5123}, {"count", 0}, {"type", "SCALAR"}});
    file.root["meshes"][0]["primitives"].push_back(lines);
    file.root["meshes"][0]["primitives"].push_back(empty);
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(read.mesh.triangles.size(), 4U);
}

// ---- nodes ----------------------------------------------------------------------------------------------------------

TEST(GltfRead, FilesWithoutScenesOrNodesShowWhatTheyHave) {
    GltfBuilder file = tetrahedron();
    file.root.erase("scenes");
    file.root["nodes"] = Json::array({{{"mesh", 0}}, {{"children", Json::array({0})}, {"translation", {5, 0, 0}}}});
    const GltfRead no_scene = read_gltf_file(file);
    ASSERT_TRUE(no_scene.ok) << no_scene.message;
    ASSERT_EQ(no_scene.mesh.positions.size(), 4U);
    EXPECT_EQ(no_scene.mesh.positions[0], (Point{5, 0, 0}));

    file.root.erase("nodes");
    const GltfRead no_nodes = read_gltf_file(file);
    ASSERT_TRUE(no_nodes.ok) << no_nodes.message;
    EXPECT_EQ(no_nodes.mesh.positions[0], (Point{0, 0, 0}));

    GltfBuilder missing = tetrahedron();
    missing.root["scene"] = 3;
    EXPECT_TRUE(says(read_gltf_file(missing).message, "scenes")) << read_gltf_file(missing).message;
}

TEST(GltfRead, SharedNodesThatMultiplyEndWithAMessage) {
    GltfBuilder file = tetrahedron();
    file.root["nodes"] = Json::array();
    for (int i = 0; i < 60; ++i) file.root["nodes"].push_back({{"children", Json::array({i + 1, i + 1})}});
    file.root["nodes"].push_back(Json::object());
    EXPECT_TRUE(says(read_gltf_file(file).message, "too many nodes")) << read_gltf_file(file).message;
}

TEST(GltfRead, InstancesAreWrittenOut) {
    GltfBuilder file = tetrahedron();
    const size_t places = file.accessor<float>("VEC3", {10, 0, 0, 0, 20, 0});
    const size_t turns = file.accessor<int16_t>("VEC4", {0, 0, 0, 32767, 0, 0, 32767, 0});  // by 180 degrees about z
    file.root["accessors"][turns]["normalized"] = true;
    const size_t sizes = file.accessor<float>("VEC3", {1, 1, 1, -3, 3, 3});
    file.node()["translation"] = {0, 0, 100};
    file.node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", places}, {"ROTATION", turns}, {"SCALE", sizes}};
    file.use_extension("EXT_mesh_gpu_instancing");
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    ASSERT_EQ(read.mesh.positions.size(), 8U);
    expect_point(read.mesh.positions[1], {11, 0, 100});
    expect_point(read.mesh.positions[5], {3, 20, 100});
    expect_point(read.mesh.positions[6], {0, 17, 100});
    EXPECT_EQ(read.mesh.triangles[0], (Triangle{0, 2, 1}));
    EXPECT_EQ(read.mesh.triangles[4], (Triangle{4, 5, 6})) << "the second one is mirrored";

    file.root["accessors"][turns]["count"] = 1;
    EXPECT_TRUE(says(read_gltf_file(file).message, "different counts")) << read_gltf_file(file).message;
}

TEST(GltfRead, HiddenNodesStayHidden) {
    GltfBuilder file = tetrahedron();
    file.root["nodes"].push_back({{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
    file.root["scenes"][0]["nodes"] = {0, 1};
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(read.mesh.positions.size(), 4U);
}

// ---- morph targets and skins ----------------------------------------------------------------------------------------

TEST(GltfRead, DefaultMorphWeightsAreApplied) {
    GltfBuilder file = tetrahedron();
    const size_t up = file.accessor<float>("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3});
    const size_t rows = file.view<uint8_t>({1});
    const size_t values = file.view<float>({2, 0, 0});
    const size_t aside = file.add("accessors", {{"componentType", 5126},
                                                {"count", 4},
                                                {"type", "VEC3"},
                                                {"sparse",
                                                 {{"count", 1},
                                                  {"indices", {{"bufferView", rows}, {"componentType", 5121}}},
                                                  {"values", {{"bufferView", values}}}}}});
    file.primitive()["targets"] = Json::array({{{"POSITION", up}}, {{"POSITION", aside}}});
    EXPECT_EQ(read_gltf_file(file).mesh.positions[3], (Point{0, 0, 1})) << "no weights: nothing moves";
    file.root["meshes"][0]["weights"] = {1, 0.5};
    const GltfRead of_mesh = read_gltf_file(file);
    ASSERT_TRUE(of_mesh.ok) << of_mesh.message;
    EXPECT_EQ(of_mesh.mesh.positions[3], (Point{0, 0, 4}));
    EXPECT_EQ(of_mesh.mesh.positions[1], (Point{2, 0, 0}));
    file.node()["weights"] = {0.5, 0};
    const GltfRead of_node = read_gltf_file(file);
    ASSERT_TRUE(of_node.ok) << of_node.message;
    EXPECT_EQ(of_node.mesh.positions[3], (Point{0, 0, 2.5}));
    EXPECT_EQ(of_node.mesh.positions[1], (Point{1, 0, 0}));

    file.root["accessors"][up]["count"] = 3;
    EXPECT_TRUE(says(read_gltf_file(file).message, "morph target")) << read_gltf_file(file).message;
}

TEST(GltfRead, MorphTargetsMoveColoursToo) {
    GltfBuilder file = tetrahedron();
    file.attribute("COLOR_0", file.accessor<float>("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
    const size_t redder = file.accessor<float>("VEC3", {1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0});
    file.primitive()["targets"] = Json::array({{{"COLOR_0", redder}}});
    file.root["meshes"][0]["weights"] = {1};
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    ASSERT_FALSE(read.mesh.appearance.corner_colors.empty());
    EXPECT_EQ(read.mesh.appearance.corner_colors[0][0], (std::array<float, 3>{1, 0, 0}));
}

// A tetrahedron whose top follows joint 2 (up by 10) and whose base follows joint 1 (aside by 5).
GltfBuilder skinned() {
    GltfBuilder file = tetrahedron();
    file.attribute("JOINTS_0", file.accessor<uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}));
    const size_t weights = file.accessor<uint8_t>("VEC4", {255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0});
    file.root["accessors"][weights]["normalized"] = true;
    file.attribute("WEIGHTS_0", weights);
    file.root["nodes"] = Json::array({{{"mesh", 0}, {"skin", 0}, {"translation", {1000, 0, 0}}},
                                      {{"translation", {5, 0, 0}}, {"children", Json::array({2})}},
                                      {{"translation", {0, 0, 10}}}});
    file.root["scenes"][0]["nodes"] = {0, 1};
    file.root["skins"] = Json::array({{{"joints", {1, 2}}}});
    return file;
}

TEST(GltfRead, SkinsTakeTheFilesPose) {
    GltfBuilder file = skinned();
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_TRUE(read.warnings.empty()) << read.all_warnings;
    ASSERT_EQ(read.mesh.positions.size(), 4U);
    expect_point(read.mesh.positions[1], {6, 0, 0});  // the mesh's own node has no part in it
    expect_point(read.mesh.positions[3], {5, 0, 11});

    // Inverse bind matrices undo the first joint and halve what follows the second.
    const std::vector<float> inverse = {1,   0, 0, 0, 0, 1,   0, 0, 0, 0, 1,   0, -5, 0, 0, 1,
                                        0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0,  0, 0, 1};
    file.root["skins"][0]["inverseBindMatrices"] = file.accessor("MAT4", inverse);
    const GltfRead bound = read_gltf_file(file);
    ASSERT_TRUE(bound.ok) << bound.message;
    expect_point(bound.mesh.positions[1], {1, 0, 0});
    expect_point(bound.mesh.positions[3], {5, 0, 10.5});
}

TEST(GltfRead, WeightsAreSharedAmongEightJoints) {
    GltfBuilder file = skinned();
    const std::vector<uint8_t> second(16, 1);
    file.attribute("JOINTS_1", file.accessor("VEC4", second));
    const std::vector<float> weights = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0};
    file.attribute("WEIGHTS_1", file.accessor("VEC4", weights));
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    expect_point(read.mesh.positions[1], {6, 0, 5});  // half of each, since weights are made to sum to 1
}

TEST(GltfRead, MirroredSkinsKeepFacesOutward) {
    GltfBuilder file = skinned();
    file.root["nodes"][1]["scale"] = {-1, 1, 1};
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_EQ(read.mesh.triangles[0], (Triangle{0, 1, 2}));
}

TEST(GltfRead, UnusableSkinsGiveAWarningAndTheRestPose) {
    for (const char* damage : {"joint", "list", "weights", "matrices", "skin"}) {
        GltfBuilder file = skinned();
        if (std::string(damage) == "joint") file.root["skins"][0]["joints"] = {1};
        if (std::string(damage) == "list") file.root["skins"][0]["joints"] = {1, 99};
        if (std::string(damage) == "weights") file.primitive()["attributes"].erase("WEIGHTS_0");
        if (std::string(damage) == "matrices") file.root["skins"][0]["inverseBindMatrices"] = 0;
        if (std::string(damage) == "skin") file.node()["skin"] = 7;
        const GltfRead read = read_gltf_file(file);
        ASSERT_TRUE(read.ok) << damage << read.message;
        expect_point(read.mesh.positions[1], {1001, 0, 0});
        ASSERT_EQ(read.warnings.size(), 1U) << damage << read.all_warnings;
        EXPECT_TRUE(says(read.all_warnings, "rest pose")) << read.all_warnings;
    }
}

// ---- extensions and versions ----------------------------------------------------------------------------------------

TEST(GltfRead, UnknownExtensionsAreNamed) {
    GltfBuilder required = tetrahedron();
    required.use_extension("ACME_twist");
    EXPECT_FALSE(read_gltf_file(required).ok);
    EXPECT_TRUE(says(read_gltf_file(required).message, "ACME_twist"));

    GltfBuilder used = tetrahedron();
    used.use_extension("ACME_twist", false);
    const GltfRead warned = read_gltf_file(used);
    ASSERT_TRUE(warned.ok) << warned.message;
    EXPECT_TRUE(says(warned.all_warnings, "ACME_twist")) << warned.all_warnings;

    GltfBuilder harmless = tetrahedron();
    for (const char* name : {"KHR_materials_clearcoat", "KHR_lights_punctual", "KHR_xmp_json_ld", "VRMC_vrm",
                             "EXT_texture_webp", "KHR_materials_unlit"}) {
        harmless.use_extension(name);
    }
    const GltfRead quiet = read_gltf_file(harmless);
    ASSERT_TRUE(quiet.ok) << quiet.message;
    EXPECT_TRUE(quiet.warnings.empty()) << quiet.all_warnings;
}

TEST(GltfRead, OtherVersionsAreNamed) {
    GltfBuilder file = tetrahedron();
    for (const Json& version : {Json("1.0"), Json("1.1"), Json(1), Json(1.0)}) {
        file.root["asset"]["version"] = version;
        EXPECT_TRUE(says(read_gltf_file(file).message, "glTF 1.0; only 2.0 is read")) << read_gltf_file(file).message;
    }
    file.root["asset"]["version"] = "3.0";
    EXPECT_TRUE(says(read_gltf_file(file).message, "glTF 3.0")) << read_gltf_file(file).message;
    file.root["asset"] = {{"version", "2.1"}, {"minVersion", "2.1"}};
    EXPECT_TRUE(says(read_gltf_file(file).message, "glTF 2.1")) << read_gltf_file(file).message;
    file.root["asset"] = {{"version", "2.1"}};
    EXPECT_TRUE(read_gltf_file(file).ok) << "a later minor version that older readers may read";
}

// ---- colours --------------------------------------------------------------------------------------------------------

std::string png_uri() {
    const std::vector<uint8_t> rgb = {255, 0, 0, 0, 0, 255};
    const std::vector<uint8_t> png = png_bytes(rgb.data(), 2, 1);
    return "data:image/png;base64," + test::base64(std::string(png.begin(), png.end()));
}

GltfBuilder textured() {
    GltfBuilder file = tetrahedron();
    file.attribute("TEXCOORD_0", file.accessor<float>("VEC2", {0, 0, 1, 0, 0, 1, 0.5, 0.5}));
    file.primitive()["material"] = 0;
    file.root["materials"] = Json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
    file.root["textures"] = Json::array({{{"source", 0}}});
    file.root["images"] = Json::array({{{"uri", png_uri()}}});
    return file;
}

// Texture coordinates of the corners of triangle 1: vertices 0, 1, 3.
std::array<std::array<float, 2>, 3> texcoords(const GltfRead& read) {
    return read.mesh.appearance.corner_texcoords.size() > 1 ? read.mesh.appearance.corner_texcoords[1]
                                                            : std::array<std::array<float, 2>, 3>{};
}

TEST(GltfRead, TextureTransformsMoveTheCoordinates) {
    GltfBuilder file = textured();
    const GltfRead plain = read_gltf_file(file);
    ASSERT_TRUE(plain.ok) << plain.message;
    EXPECT_EQ(texcoords(plain)[1], (std::array<float, 2>{1, 0}));
    ASSERT_EQ(plain.mesh.appearance.textures.size(), 1U);

    Json& info = file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["extensions"]["KHR_texture_transform"] = {{"offset", {0.5, 0.25}}, {"scale", {0.5, 3}}};
    const GltfRead moved = read_gltf_file(file);
    EXPECT_EQ(texcoords(moved)[1], (std::array<float, 2>{1, 0.25}));
    EXPECT_EQ(texcoords(moved)[2], (std::array<float, 2>{0.75, 1.75}));

    // A quarter turn, counter-clockwise as the image is seen: right becomes up, and v points down.
    info["extensions"]["KHR_texture_transform"] = {{"rotation", std::numbers::pi / 2}};
    const GltfRead turned = read_gltf_file(file);
    EXPECT_NEAR(texcoords(turned)[1][0], 0, 1e-6);
    EXPECT_NEAR(texcoords(turned)[1][1], -1, 1e-6);

    file.attribute("TEXCOORD_3", file.accessor<float>("VEC2", {9, 9, 9, 9, 9, 9, 9, 9}));
    info["extensions"]["KHR_texture_transform"] = {{"texCoord", 3}};
    EXPECT_EQ(texcoords(read_gltf_file(file))[1], (std::array<float, 2>{9, 9}));
}

TEST(GltfRead, ImagesThatCannotBeReadAreNamedAndLeftOut) {
    for (const auto& [image, word] : std::vector<std::pair<Json, std::string>>{
             {{{"uri", "%!QAA"}}, "%!QAA"},
             {{{"uri", "no such file.png"}}, "no such file"},
             {{{"uri", "data:image/png;base64,@@"}}, "base64"},
             {{{"uri", "data:image/png;base64," + test::base64("RIFF....WEBPVP8 ")}}, "WebP"},
             {{{"uri", "data:;base64," + test::base64("\xABKTX 20\xBB")}}, "KTX"},
             {{{"uri", "data:;base64," + test::base64("rubbish")}}, "not an image"},
             {{{"uri", "https://example.org/a.png"}}, "address"},
             {{{"bufferView", 99}}, "99"},
             {Json::object(), "empty"}}) {
        GltfBuilder file = textured();
        file.root["images"][0] = image;
        const GltfRead read = read_gltf_file(file);
        ASSERT_TRUE(read.ok) << read.message;
        EXPECT_EQ(read.mesh.triangles.size(), 4U);
        EXPECT_TRUE(read.mesh.appearance.empty());
        ASSERT_EQ(read.warnings.size(), 1U) << read.all_warnings;
        EXPECT_TRUE(says(read.all_warnings, word)) << read.all_warnings;
    }
    GltfBuilder basis = textured();
    basis.root["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
    EXPECT_TRUE(says(read_gltf_file(basis).all_warnings, "KHR_texture_basisu"));

    const GltfRead bare = read_gltf_text(R"({"asset":{"version":"2.0"},"images":[{"uri":"%!QAA"}]})");
    EXPECT_TRUE(says(bare.message, "no triangles") && says(bare.message, "%!QAA")) << bare.message;
}

TEST(GltfRead, ColoursThatDoNotFitAreLeftOutWithAWarning) {
    GltfBuilder file = tetrahedron();
    file.attribute("COLOR_0", file.accessor<float>("VEC3", {1, 0, 0}));
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok) << read.message;
    EXPECT_TRUE(says(read.all_warnings, "COLOR_0")) << read.all_warnings;
}

TEST(GltfRead, IntegerColoursAreFractionsWhateverTheySay) {
    GltfBuilder file = tetrahedron();
    file.attribute("COLOR_0", file.accessor<uint8_t>("VEC4", {255, 0, 0, 9, 255, 0, 0, 9, 255, 0, 0, 9, 255, 0, 0, 9}));
    for (const bool normalized : {false, true}) {
        file.root["accessors"].back()["normalized"] = normalized;
        const GltfRead read = read_gltf_file(file);
        ASSERT_TRUE(read.ok && !read.mesh.appearance.corner_colors.empty()) << read.message;
        EXPECT_EQ(read.mesh.appearance.corner_colors[0][0], (std::array<float, 3>{1, 0, 0}));
    }
    // One part in 255 is dark, not white.
    GltfBuilder dark = tetrahedron();
    dark.attribute("COLOR_0", dark.accessor<uint8_t>("VEC4", std::vector<uint8_t>(16, 1)));
    EXPECT_LT(read_gltf_file(dark).mesh.appearance.corner_colors.at(0)[0][0], 0.1F);
}

TEST(GltfRead, OlderMaterialsGiveTheirDiffuseColour) {
    GltfBuilder file = tetrahedron();
    file.primitive()["material"] = 0;
    file.root["materials"] =
        Json::array({{{"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {1, 0, 0, 1}}}}}}}});
    const GltfRead read = read_gltf_file(file);
    ASSERT_TRUE(read.ok && !read.mesh.appearance.corner_colors.empty()) << read.message;
    EXPECT_EQ(read.mesh.appearance.corner_colors[0][0], (std::array<float, 3>{1, 0, 0}));
}

}  // namespace
}  // namespace gim
