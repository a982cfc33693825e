// Textures of meshes that become .gim land where they were.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/tools/glb_scene.h"
#include "tools/gltf_primitive.h"
#include "tools/texture_picture.h"

namespace gim {
namespace {

using Eigen::Vector3d;
using test::decode_bytes;
using test::encode_text;
using test::GltfBuilder;
using test::Json;
using test::json_of;
using test::Made;
using test::quick;
using test::says;

using Color = std::array<uint8_t, 4>;

// A picture of 64 x 64 pixels. color(u, v): 0..1 at the middle of a pixel.
template <class F>
size_t add_picture(GltfBuilder& file, int channels, const F& color) {
    constexpr uint32_t kSide = 64;
    std::vector<uint8_t> pixels;
    for (uint32_t row = 0; row < kSide; ++row) {
        for (uint32_t column = 0; column < kSide; ++column) {
            const Color c = color((column + 0.5) / kSide, (row + 0.5) / kSide);
            pixels.insert(pixels.end(), c.begin(), c.begin() + channels);
        }
    }
    const size_t view = file.view(encode_png(pixels, kSide, kSide, channels));
    const size_t image = file.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
    const size_t sampler = file.add("samplers", {{"wrapS", 33071}, {"wrapT", 33071}});  // clamped
    return file.add("textures", {{"source", image}, {"sampler", sampler}});
}

uint8_t byte_of(double value) { return static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

// Red rises with u, green with v.
size_t add_slope(GltfBuilder& file, int channels = 3) {
    return add_picture(file, channels, [](double u, double v) {
        return Color{byte_of(u), byte_of(v), 50, byte_of(1 - u)};
    });
}

// Coordinates u = (x + 1) / 2, v = (y + 1) / 2 of all vertices.
size_t add_texcoords(GltfBuilder& file, double scale = 1) {
    std::vector<float> uv;
    for (const auto& p : corpus::sphere(16).positions)
        for (size_t k = 0; k < 2; ++k) uv.push_back(static_cast<float>(scale * (p[k] + 1) / 2));
    return file.accessor<float>("VEC2", uv);
}

// A sphere whose primitives all have the coordinates.
GltfBuilder sphere(bool halved) {
    GltfBuilder file;
    std::vector<size_t> all(corpus::sphere(16).triangles.size());
    for (size_t t = 0; t < all.size(); ++t) all[t] = t;
    Json primitives =
        halved ? test::halved_sphere(file, 16) : Json::array({test::primitive_of(file, corpus::sphere(16), all)});
    for (Json& primitive : primitives) {
        primitive["attributes"]["TEXCOORD_0"] = add_texcoords(file);
        primitive["material"] = 0;
    }
    file.root["meshes"][0]["primitives"] = primitives;
    return file;
}

// A primitive of a GLB with its arrays.
struct Surface {
    std::vector<Vector3d> positions, normals;
    std::vector<std::array<double, 2>> texcoords;
    std::vector<std::array<double, 4>> tangents;
    Json material, root;
    std::string glb;

    Surface(const Bytes& bytes, size_t primitive_index = 0) : root(json_of(bytes)), glb(bytes.begin(), bytes.end()) {
        ReadContext context;
        gltf::File file(glb, context);
        gltf::DracoMeshes draco;
        const std::vector<double> weights;
        const Json& object = root["meshes"][0]["primitives"][primitive_index];
        material = root["materials"][object["material"].get<size_t>()];
        gltf::Primitive primitive(file, draco, object, weights);
        const auto at = [&](const char* name, size_t width, const auto& use) {
            if (!primitive.has(name)) return;
            const gltf::MorphedColumn column = primitive.attribute(name, width);
            for (uint64_t row = 0; row < column.base.count; ++row) use(column, row);
        };
        const auto triple = [](const auto& c, uint64_t row) {
            return Vector3d(c.at(row, 0), c.at(row, 1), c.at(row, 2));
        };
        at("POSITION", 3, [&](const auto& c, uint64_t row) { positions.push_back(triple(c, row)); });
        at("NORMAL", 3, [&](const auto& c, uint64_t row) { normals.push_back(triple(c, row)); });
        at("TEXCOORD_0", 2, [&](const auto& c, uint64_t row) { texcoords.push_back({c.at(row, 0), c.at(row, 1)}); });
        at("TANGENT", 4, [&](const auto& c, uint64_t row) {
            tangents.push_back({c.at(row, 0), c.at(row, 1), c.at(row, 2), c.at(row, 3)});
        });
    }

    RgbaPicture picture(const Json& info) const {
        const Json& texture = root["textures"][info["index"].get<size_t>()];
        const Json& image = root["images"][texture["source"].get<size_t>()];
        ReadContext context;
        gltf::File file(glb, context);
        return decode_rgba(file.view(image["bufferView"].get<uint64_t>()));
    }
    std::array<double, 4> color(const RgbaPicture& picture, size_t vertex) const {
        return sample(picture, texcoords[vertex][0], texcoords[vertex][1], TextureWrap::kClamp, TextureWrap::kClamp,
                      false);
    }
};

// The share of vertices whose colour is not the one that expected(position) gives, up to a few levels of 8 bits.
template <class F>
double wrong_share(const Surface& surface, const Json& info, const F& expected) {
    const RgbaPicture picture = surface.picture(info);
    size_t wrong = 0;
    for (size_t v = 0; v < surface.positions.size(); ++v) {
        const std::array<double, 4> found = surface.color(picture, v), wanted = expected(surface.positions[v]);
        double most = 0;
        for (size_t k = 0; k < 4; ++k) most = std::max(most, std::abs(found[k] - wanted[k]));
        wrong += most > 8.0 / 255 ? 1 : 0;
    }
    return double(wrong) / double(surface.positions.size());
}

std::array<double, 4> slope_at(const Vector3d& p) { return {(p.x() + 1) / 2, (p.y() + 1) / 2, 50 / 255.0, 1}; }

GlbEncodeOptions with_layout(Layout layout) {
    GlbEncodeOptions options = quick();
    options.mesh.layout = layout;
    return options;
}

TEST(GlbTextures, ColorsLandWhereTheyWere) {
    for (const Layout layout : {Layout::kGim, Layout::kTiles}) {
        GltfBuilder file = sphere(false);
        file.root["materials"] = {
            {{"name", "sloped"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", add_slope(file)}}}}}}};
        const Made made = encode_text(file.text(), with_layout(layout));
        ASSERT_TRUE(made.glb.meshes[0].is_carried) << made.warnings;
        const Surface surface(decode_bytes(made.glb.glb));
        EXPECT_EQ(surface.material["name"], "sloped");
        const double wrong =
            wrong_share(surface, surface.material["pbrMetallicRoughness"]["baseColorTexture"], slope_at);
        EXPECT_LT(wrong, 0.01);
        // The old picture and the old material are gone.
        EXPECT_EQ(surface.root["images"].size(), 1u);
        EXPECT_EQ(surface.root["materials"].size(), 1u);
    }
}

TEST(GlbTextures, TransformsAndSetsOfCoordinatesApply) {
    GltfBuilder file = sphere(true);
    const size_t slope = add_slope(file);
    file.root["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", slope}}}}}},
        {{"emissiveTexture",
          {{"index", slope},
           {"texCoord", 1},
           {"extensions", {{"KHR_texture_transform", {{"scale", {0.25, 0.25}}, {"offset", {0.5, 0.25}}}}}}}}}};
    file.use_extension("KHR_texture_transform", false);
    Json& second = file.root["meshes"][0]["primitives"][1];
    second["material"] = 1;
    second["attributes"]["TEXCOORD_1"] = add_texcoords(file, 2);
    const Made made = encode_text(file.text(), quick());
    ASSERT_TRUE(made.glb.meshes[0].is_carried) << made.warnings;
    const Bytes plain = decode_bytes(made.glb.glb);
    const Surface left(plain, 0), right(plain, 1);
    EXPECT_LT(wrong_share(left, left.material["pbrMetallicRoughness"]["baseColorTexture"], slope_at), 0.02);
    const Json& info = right.material["emissiveTexture"];
    EXPECT_FALSE(info.contains("texCoord"));
    EXPECT_FALSE(info.contains("extensions"));
    const double wrong = wrong_share(right, info, [](const Vector3d& p) {
        return std::array<double, 4>{0.5 + 0.25 * (p.x() + 1), 0.25 + 0.25 * (p.y() + 1), 50 / 255.0, 1};
    });
    EXPECT_LT(wrong, 0.02);
}

TEST(GlbTextures, AlphaStaysWhereAMaterialNeedsIt) {
    for (const bool is_masked : {false, true}) {
        GltfBuilder file = sphere(false);
        file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", add_slope(file, 4)}}}}}}};
        if (is_masked) file.root["materials"][0]["alphaMode"] = "MASK";
        const Made made = encode_text(file.text(), quick());
        const Surface surface(decode_bytes(made.glb.glb));
        const Json& info = surface.material["pbrMetallicRoughness"]["baseColorTexture"];
        const double wrong = wrong_share(surface, info, [&](const Vector3d& p) {
            return std::array<double, 4>{(p.x() + 1) / 2, (p.y() + 1) / 2, 50 / 255.0,
                                         is_masked ? 1 - (p.x() + 1) / 2 : 1};
        });
        EXPECT_LT(wrong, 0.01) << is_masked;
    }
}

TEST(GlbTextures, ColorsOfVerticesBecomeATexture) {
    GltfBuilder file = sphere(false);
    std::vector<float> colors;
    for (const auto& p : corpus::sphere(16).positions)
        for (const double x : {(p[0] + 1) / 2, (p[1] + 1) / 2, 1.0}) colors.push_back(static_cast<float>(x));
    file.attribute("COLOR_0", file.accessor<float>("VEC3", colors));
    file.root["materials"] = {{{"name", "plain"}}};
    const Made made = encode_text(file.text(), quick());
    ASSERT_TRUE(made.glb.meshes[0].is_carried) << made.warnings;
    const Surface surface(decode_bytes(made.glb.glb));
    const auto srgb = [](double linear) { return srgb_byte(linear) / 255.0; };
    const double wrong =
        wrong_share(surface, surface.material["pbrMetallicRoughness"]["baseColorTexture"], [&](const Vector3d& p) {
            return std::array<double, 4>{srgb((p.x() + 1) / 2), srgb((p.y() + 1) / 2), 1, 1};
        });
    EXPECT_LT(wrong, 0.05);
}

// A normal texture that leans everywhere towards rising u and falling v, so towards rising x and falling y.
TEST(GlbTextures, NormalsKeepTheirDirection) {
    GltfBuilder file = sphere(false);
    const Vector3d lean(0.4, 0.3, std::sqrt(1 - 0.25));
    const size_t texture = add_picture(file, 3, [&](double, double) {
        return Color{byte_of((1 + lean.x()) / 2), byte_of((1 + lean.y()) / 2), byte_of((1 + lean.z()) / 2), 255};
    });
    file.root["materials"] = {{{"normalTexture", {{"index", texture}}}}};
    const Made made = encode_text(file.text(), quick());
    ASSERT_TRUE(made.glb.meshes[0].is_carried) << made.warnings;
    const Surface surface(decode_bytes(made.glb.glb));
    const RgbaPicture picture = surface.picture(surface.material["normalTexture"]);
    ASSERT_EQ(surface.tangents.size(), surface.positions.size());
    size_t tested = 0, wrong = 0;
    for (size_t v = 0; v < surface.positions.size(); ++v) {
        const Vector3d n = surface.positions[v].normalized();
        if (std::abs(n.z()) < 0.6) continue;  // coordinates say little near the rim
        const Vector3d u = Vector3d(n.z(), 0, -n.x()).normalized() * (n.z() < 0 ? -1 : 1);  // v stays
        const Vector3d across = n.cross(u), up = across.y() < 0 ? across : Vector3d(-across);
        const Vector3d expected = u * lean.x() + up * lean.y() + n * lean.z();
        const std::array<double, 4> rgb = surface.color(picture, v);
        const Vector3d own = surface.normals[v];
        const Vector3d t(surface.tangents[v][0], surface.tangents[v][1], surface.tangents[v][2]);
        const Vector3d b = own.cross(t) * surface.tangents[v][3];
        const Vector3d found = (t * (2 * rgb[0] - 1) + b * (2 * rgb[1] - 1) + own * (2 * rgb[2] - 1)).normalized();
        ++tested;
        wrong += found.dot(expected) < std::cos(10 * std::numbers::pi / 180) ? 1 : 0;
    }
    EXPECT_GT(tested, 300u);
    EXPECT_LT(double(wrong), 0.02 * double(tested));
}

// Several components are several images: each has its place in the atlas.
TEST(GlbTextures, PartsHaveTheirPlaces) {
    GltfBuilder file;
    TriangleMesh mesh = corpus::sphere(10);
    const auto count = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t v = 0; v < count; ++v) {
        const auto p = mesh.positions[v];
        mesh.positions.push_back({0.4 * p[0] + 3, 0.4 * p[1], 0.4 * p[2]});
    }
    for (size_t t = mesh.triangles.size(); t-- > 0;) {
        const auto c = mesh.triangles[t];
        mesh.triangles.push_back({c[0] + count, c[1] + count, c[2] + count});
    }
    std::vector<size_t> all(mesh.triangles.size());
    for (size_t t = 0; t < all.size(); ++t) all[t] = t;
    Json primitive = test::primitive_of(file, mesh, all);
    std::vector<float> uv;
    for (const auto& p : mesh.positions) {
        uv.push_back(static_cast<float>((p[0] + 1) / 4.4));
        uv.push_back(static_cast<float>((p[1] + 1) / 2));
    }
    primitive["attributes"]["TEXCOORD_0"] = file.accessor<float>("VEC2", uv);
    primitive["material"] = 0;
    file.root["meshes"][0]["primitives"][0] = primitive;
    file.root["materials"] = {{{"emissiveTexture", {{"index", add_slope(file)}}}}};
    const Made made = encode_text(file.text(), with_layout(Layout::kGim));
    ASSERT_TRUE(made.glb.meshes[0].is_carried) << made.warnings;
    const Json told = json_of(made.glb.glb)["meshes"][0]["primitives"][0]["extensions"]["EXT_gim_geometry"];
    EXPECT_EQ(told["places"].size(), 6u);
    const Surface surface(decode_bytes(made.glb.glb));
    const double wrong = wrong_share(surface, surface.material["emissiveTexture"], [](const Vector3d& p) {
        return std::array<double, 4>{(p.x() + 1) / 4.4, (p.y() + 1) / 2, 50 / 255.0, 1};
    });
    EXPECT_LT(wrong, 0.02);
}

TEST(GlbTextures, PicturesThatGimCannotReadKeepTheMesh) {
    GltfBuilder file = sphere(false);
    const size_t image =
        file.add("images", {{"bufferView", file.view(std::vector<uint8_t>(40, 7))}, {"mimeType", "image/png"}});
    file.root["materials"] = {{{"emissiveTexture", {{"index", file.add("textures", {{"source", image}})}}}}};
    const Made made = encode_text(file.text(), quick());
    EXPECT_FALSE(made.glb.meshes[0].is_carried);
    EXPECT_TRUE(says(made.warnings, "no picture that gim can read")) << made.warnings;
}

}  // namespace
}  // namespace gim
