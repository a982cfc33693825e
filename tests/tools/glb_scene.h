// A glTF scene with meshes that become .gim and with others, for the tests.
#pragma once

#include <gtest/gtest.h>

#include "corpus/generators.h"
#include "tests/tools/gltf_builder.h"
#include "tools/encode_glb.h"

namespace gim::test {

// Triangles of a mesh as one primitive, with vertex normals of a sphere.
inline Json primitive_of(GltfBuilder& file, const TriangleMesh& mesh, const std::vector<size_t>& triangles) {
    std::vector<float> positions, normals;
    std::vector<uint32_t> indices;
    for (const auto& p : mesh.positions) {
        for (const double x : p) positions.push_back(static_cast<float>(x));
        for (const double x : p) normals.push_back(static_cast<float>(x));
    }
    for (const size_t t : triangles) indices.insert(indices.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
    return {
        {"attributes",
         {{"POSITION", file.accessor<float>("VEC3", positions)}, {"NORMAL", file.accessor<float>("VEC3", normals)}}},
        {"indices", file.accessor<uint32_t>("SCALAR", indices)}};
}

// The halves of a sphere as two primitives.
inline Json halved_sphere(GltfBuilder& file, uint32_t n) {
    const TriangleMesh sphere = corpus::sphere(n);
    std::vector<size_t> sides[2];
    for (size_t t = 0; t < sphere.triangles.size(); ++t) {
        double x = 0;
        for (const uint32_t v : sphere.triangles[t]) x += sphere.positions[v][0];
        sides[x > 0 ? 1 : 0].push_back(t);
    }
    Json primitives = Json::array();
    for (const auto& side : sides) primitives.push_back(primitive_of(file, sphere, side));
    return primitives;
}

// A sphere of two materials that two nodes use, one of them animated; and a mesh with a skin, one with morph targets, one
// of points; a camera, a light, names and extras.
inline GltfBuilder make_scene() {
    GltfBuilder file;
    Json& root = file.root;
    root["materials"] = {{{"name", "red"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}},
                         {{"name", "shiny"}, {"extras", {{"kept", true}}}}};
    Json halves = halved_sphere(file, 16);
    halves[0]["material"] = 0;
    halves[0]["extras"] = {{"side", "left"}};
    halves[1]["material"] = 1;
    root["meshes"] = {{{"name", "ball"}, {"primitives", halves}, {"extras", 5}}};

    file.root["meshes"].push_back({{"name", "skinned"}, {"primitives", {Json::object()}}});
    Json tetrahedron = {
        {"attributes", {{"POSITION", file.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1})}}},
        {"indices", file.accessor<uint16_t>("SCALAR", {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2})}};
    for (const char* name : {"min", "max"})
        root["accessors"][tetrahedron["attributes"]["POSITION"].get<size_t>()][name] =
            name[1] == 'i' ? Json{0, 0, 0} : Json{1, 1, 1};
    Json skinned = tetrahedron, morphing = tetrahedron, points = tetrahedron;
    skinned["attributes"]["JOINTS_0"] = file.accessor<uint8_t>("VEC4", std::vector<uint8_t>(16, 0));
    skinned["attributes"]["WEIGHTS_0"] = file.accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    root["meshes"][1]["primitives"][0] = skinned;
    const size_t moved = file.accessor<float>("VEC3", std::vector<float>(12, 0.5f));
    root["accessors"][moved]["min"] = root["accessors"][moved]["max"] = {0.5, 0.5, 0.5};
    morphing["targets"] = {{{"POSITION", moved}}};
    root["meshes"].push_back({{"name", "morphing"}, {"primitives", {morphing}}, {"weights", {0.5}}});
    points["mode"] = 0;
    points.erase("indices");
    root["meshes"].push_back({{"name", "points"}, {"primitives", {points}}});

    root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    root["extensionsUsed"] = {"KHR_lights_punctual"};
    root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", "lamp"}}};
    root["nodes"] = {{{"name", "first"}, {"mesh", 0}, {"translation", {1, 2, 3}}, {"children", {1}}},
                     {{"name", "second"}, {"mesh", 0}, {"scale", {2, 2, 2}}},
                     {{"name", "bone"}},
                     {{"mesh", 1}, {"skin", 0}},
                     {{"mesh", 2}},
                     {{"mesh", 3}},
                     {{"camera", 0}},
                     {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    root["skins"] = {{{"joints", {2}}}};
    root["scenes"] = {{{"nodes", {0, 2, 3, 4, 5, 6, 7}}}};
    const size_t times = file.accessor<float>("SCALAR", {0, 1});
    root["accessors"][times]["min"] = {0};
    root["accessors"][times]["max"] = {1};
    root["animations"] = {
        {{"name", "rise"},
         {"samplers", {{{"input", times}, {"output", file.accessor<float>("VEC3", {0, 0, 0, 0, 5, 0})}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}}};
    return file;
}

inline std::string as_text(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

inline GlbEncodeOptions quick() {
    GlbEncodeOptions options;
    options.mesh.side = 33;
    options.mesh.samples = 1500;
    options.mesh.threads = 2;
    return options;
}

// What the encoder makes of a file.
struct Made {
    EncodedGlb glb;
    std::string warnings;
};
inline Made encode_text(const std::string& text, const GlbEncodeOptions& options) {
    ReadContext context;
    Made made;
    auto encoded = encode_glb(text, context, options);
    EXPECT_TRUE(encoded.ok()) << encoded.error().message;
    if (encoded.ok()) made.glb = std::move(encoded.value());
    for (const std::string& warning : context.warnings) made.warnings += warning + "\n";
    return made;
}

inline Bytes decode_bytes(const Bytes& glb, uint32_t level = 0) {
    ReadContext context;
    const std::string text = as_text(glb);
    auto decoded = decode_glb(text, context, level);
    EXPECT_TRUE(decoded.ok()) << decoded.error().message;
    return decoded.ok() ? decoded.value() : Bytes{};
}

inline Json json_of(const Bytes& glb) {
    uint32_t size = 0;
    std::memcpy(&size, glb.data() + 12, 4);
    return Json::parse(glb.begin() + 20, glb.begin() + 20 + size);
}

}  // namespace gim::test
