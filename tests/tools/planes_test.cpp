// Colours and normal maps on their way through the tools: from mesh files to decoded files.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "corpus/generators.h"
#include "encoder/planes/input_colors.h"
#include "tests/tools/test_files.h"
#include "tools/commands.h"
#include "tools/input.h"
#include "tools/little_endian.h"
#include "tools/mesh_read.h"
#include "tools/plane_write.h"
#include "tools/stb.h"
#include "tools/surface_write.h"
#include "tools/tangent_space.h"

namespace gim {
namespace {

using test::save;
using test::TemporaryFolder;
using test::to_bytes;
using test::torus_image;

// Red, green / blue, white: 2 x 2 pixels, top row first.
const std::vector<uint8_t> kFourColors = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};

void save_png(const std::string& path) {
    const std::vector<uint8_t> png = png_bytes(kFourColors.data(), 2, 2);
    save(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

Input read_colored(const std::string& path) {
    Result<Input> input = read_input(path, {Want::kShapeAndColors});
    EXPECT_TRUE(input.ok()) << input.error().message;
    return input.ok() ? std::move(input.value()) : Input{};
}

using Color = std::array<float, 3>;
using Uv = std::array<float, 2>;

TEST(Colors, PlyVertexColorsAreScaledByTheirType) {
    TemporaryFolder folder;
    save(folder.file("a.ply"),
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
         "property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 51\n3 0 1 2\n");
    const Input input = read_colored(folder.file("a.ply"));
    ASSERT_EQ(input.mesh.appearance.corner_colors.size(), 1u);
    const auto& corners = input.mesh.appearance.corner_colors[0];
    EXPECT_EQ(corners[0], (Color{1, 0, 0}));
    EXPECT_EQ(corners[1], (Color{0, 1, 0}));
    EXPECT_EQ(corners[2], (Color{0, 0, 0.2f}));
    EXPECT_TRUE(read_input(folder.file("a.ply")).value().mesh.appearance.empty());
}

TEST(Colors, ATextureThatIsNamedTwiceIsReadAndMissedOnce) {
    TemporaryFolder folder;
    save_png(folder.file("a.png"));
    Textures textures(folder.path());
    EXPECT_EQ(textures.load("a.png"), textures.load("a.png"));
    EXPECT_EQ(textures.load("none.png"), textures.load("none.png"));
    EXPECT_EQ(textures.images.size(), 1u);
    EXPECT_EQ(textures.warnings.size(), 1u);
}

TEST(Colors, PlyTexturesComeWithTheirFaceCorners) {
    TemporaryFolder folder;
    save_png(folder.file("four colors.png"));
    const std::string text =
        "ply\nformat ascii 1.0\ncomment TextureFile four colors.png\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 8 0 0 1 0 1 1 0 1\n";
    save(folder.file("a.ply"), text);
    const Input input = read_colored(folder.file("a.ply"));
    EXPECT_TRUE(input.warnings.empty());
    const Appearance& a = input.mesh.appearance;
    ASSERT_EQ(a.textures.size(), 1u);
    EXPECT_EQ(a.textures[0].rgb, kFourColors);
    ASSERT_EQ(a.corner_texcoords.size(), 2u);
    EXPECT_EQ(a.corner_texcoords[1][1], (Uv{1, 0}));  // (1, 1) of PLY is the top right corner
    EXPECT_EQ(a.triangle_texture, (std::vector<uint32_t>{0, 0}));
    // The top left quarter is red, the bottom right one white.
    const std::vector<Vec3> points = {Vec3(0.25, 0.75, 0), Vec3(0.75, 0.25, 0)};
    EXPECT_EQ(InputColors(input.mesh).at(points), (std::vector<float>{255, 0, 0, 255, 255, 255}));
}

TEST(Colors, AMissingTextureIsAWarning) {
    TemporaryFolder folder;
    save(folder.file("a.obj"),
         "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n");
    Input input = read_colored(folder.file("a.obj"));
    EXPECT_EQ(input.warnings.size(), 1u);
    EXPECT_EQ(input.mesh.triangles.size(), 1u);
    EXPECT_TRUE(input.mesh.appearance.empty());
    save(folder.file("a.mtl"), "newmtl m\nmap_Kd none.png\n");
    EXPECT_EQ(read_colored(folder.file("a.obj")).warnings.size(), 1u);
    save(folder.file("none.png"), "this is no picture");
    EXPECT_EQ(read_colored(folder.file("a.obj")).warnings.size(), 1u);
    save_png(folder.file("none.png"));
    input = read_colored(folder.file("a.obj"));
    EXPECT_TRUE(input.warnings.empty());
    ASSERT_EQ(input.mesh.appearance.textures.size(), 1u);
    EXPECT_EQ(input.mesh.appearance.corner_texcoords[0][2], (Uv{0, 0}));
}

TEST(Colors, ObjTakesOptionsOfItsMapsAndPartsWithoutOne) {
    TemporaryFolder folder;
    save_png(folder.file("t.png"));
    save(folder.file("a.mtl"), "newmtl plain\nKd 0 1 0\nnewmtl map\nmap_Kd -s 1 1 1 t.png\n");
    save(folder.file("a.obj"),
         "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.25 0.75\nusemtl plain\nf 1 2 3\nusemtl map\nf 2/1 "
         "4/-1 3/1\n");
    const Input input = read_colored(folder.file("a.obj"));
    EXPECT_EQ(input.mesh.appearance.triangle_texture, (std::vector<uint32_t>{UINT32_MAX, 0}));
    const std::vector<Vec3> points = {Vec3(0.1, 0.1, 0), Vec3(0.9, 0.9, 0)};
    EXPECT_EQ(InputColors(input.mesh).at(points), (std::vector<float>{0, 255, 0, 255, 0, 0}));
}

TEST(Colors, AFileThatClaimsHugeTexturesOrBadIndicesIsReadAllTheSame) {
    TemporaryFolder folder;
    save_png(folder.file("t.png"));
    save(folder.file("a.mtl"), "newmtl m\nmap_Kd t.png\n");
    save(folder.file("a.obj"), "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/7 2/-9 3/x\n");
    const Input input = read_colored(folder.file("a.obj"));
    EXPECT_EQ(input.mesh.triangles.size(), 1u);
    EXPECT_TRUE(check_appearance(input.mesh).ok());
}

// ---- out ------------------------------------------------------------------------------------------------------------

// Colours that show the place: red by row, green by column.
ImagePlane ramp(uint32_t side) {
    ImagePlane plane{side, side, {}};
    for (uint32_t r = 0; r < side; ++r) {
        for (uint32_t c = 0; c < side; ++c) {
            const auto last = static_cast<float>(side - 1);
            for (const float v : {static_cast<float>(r) / last, static_cast<float>(c) / last, 0.5f})
                plane.values.push_back(v);
        }
    }
    return plane;
}

nlohmann::json glb_document(const Bytes& glb) {
    const uint32_t size = load_u32(reinterpret_cast<const char*>(glb.data()) + 12);
    return nlohmann::json::parse(glb.begin() + 20, glb.begin() + 20 + size);
}

TEST(Planes, GlbCarriesThemAsTexturesOfEachImage) {
    std::vector<DecodedImage> images = {torus_image(9), torus_image(5, 10), torus_image(5, 20)};
    images[0].colors = ramp(17);
    images[0].normal_map = {9, 9, images[0].grid_normals};
    images[1].normal_map = {5, 5, images[1].grid_normals};
    const Result<Bytes> glb = write_surface(SurfaceFormat::kGlb, images);
    ASSERT_TRUE(glb.ok());
    const nlohmann::json j = glb_document(glb.value());
    EXPECT_EQ(j["images"].size(), 3u);
    EXPECT_EQ(j["materials"].size(), 3u);
    const auto& first = j["meshes"][0]["primitives"][0];
    const auto& material = j["materials"][first["material"].get<size_t>()];
    EXPECT_TRUE(material["pbrMetallicRoughness"].contains("baseColorTexture"));
    EXPECT_EQ(material["normalTexture"]["texCoord"], 1);
    for (const char* name : {"TANGENT", "TEXCOORD_0", "TEXCOORD_1"}) EXPECT_TRUE(first["attributes"].contains(name));
    const auto& third = j["meshes"][2]["primitives"][0];
    EXPECT_FALSE(j["materials"][third["material"].get<size_t>()].contains("normalTexture"));
    for (const auto& accessor : j["accessors"]) {
        const auto& view = j["bufferViews"][accessor["bufferView"].get<size_t>()];
        EXPECT_EQ(view["byteOffset"].get<size_t>() % 4, 0u);
    }
}

TEST(Planes, ColorsOfAGlbReadBackAtTheirPlaces) {
    std::vector<DecodedImage> images = {torus_image(17)};
    images[0].colors = ramp(33);
    const Result<Bytes> glb = write_surface(SurfaceFormat::kGlb, images);
    ASSERT_TRUE(glb.ok());
    Textures textures("");
    ReadContext context{"", &textures};
    const Result<TriangleMesh> mesh = read_mesh(glb.value(), MeshFormat::kGltf, context);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    EXPECT_TRUE(textures.warnings.empty());
    const InputColors colors(mesh.value());
    for (const uint32_t row : {3u, 8u, 12u}) {
        for (const uint32_t column : {2u, 9u, 15u}) {
            const float* p = &images[0].grid[(size_t{row} * 17 + column) * 3];
            const std::vector<Vec3> point = {Vec3(p[0], p[1], p[2])};
            const std::vector<float> c = colors.at(point);
            EXPECT_NEAR(c[0], row * 255.0 / 16, 1) << row << " " << column;
            EXPECT_NEAR(c[1], column * 255.0 / 16, 1) << row << " " << column;
            EXPECT_NEAR(c[2], 127.5, 1);
        }
    }
}

TEST(Planes, PlyAndObjGiveColorsToTheirVertices) {
    std::vector<DecodedImage> images = {torus_image(17)};
    images[0].colors = ramp(9);
    for (const auto& [output, input] :
         {std::pair{SurfaceFormat::kPly, MeshFormat::kPly}, std::pair{SurfaceFormat::kObj, MeshFormat::kObj}}) {
        const Result<Bytes> bytes = write_surface(output, images);
        ASSERT_TRUE(bytes.ok());
        Textures textures("");
        ReadContext context{"", &textures};
        const Result<TriangleMesh> mesh = read_mesh(bytes.value(), input, context);
        ASSERT_TRUE(mesh.ok());
        ASSERT_EQ(mesh.value().appearance.corner_colors.size(), mesh.value().triangles.size());
        const auto& t = mesh.value().triangles[5];
        const auto& color = mesh.value().appearance.corner_colors[5];
        for (size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(color[k][0], images[0].texcoords[2 * t[k] + 1], 0.003);
            EXPECT_NEAR(color[k][1], images[0].texcoords[2 * t[k]], 0.003);
        }
    }
}

TEST(Planes, ANormalMapThatAgreesWithTheSurfaceIsFlat) {
    const DecodedImage image = torus_image(17);
    const std::vector<uint8_t> rgb = tangent_space_map(image, grid_tangents(image), {17, 17, image.grid_normals});
    for (size_t i = 0; i < rgb.size(); i += 3) {
        EXPECT_NEAR(rgb[i], 127.5, 1);
        EXPECT_NEAR(rgb[i + 1], 127.5, 1);
        EXPECT_EQ(rgb[i + 2], 255);
    }
}

TEST(Planes, TangentSpaceGivesBackTheNormalsThatWentIn) {
    const DecodedImage image = torus_image(33);
    const std::vector<float> tangents = grid_tangents(image);
    ImagePlane bumpy{33, 33, image.grid_normals};
    for (size_t i = 0; i < bumpy.values.size(); i += 3) {
        Vec3 n(bumpy.values[i], bumpy.values[i + 1], bumpy.values[i + 2]);
        n = (n + 0.4 * Vec3(std::sin(0.1 * double(i)), std::cos(0.3 * double(i)), std::sin(0.7 * double(i))))
                .normalized();
        for (size_t k = 0; k < 3; ++k) bumpy.values[i + k] = static_cast<float>(n[static_cast<int>(k)]);
    }
    const std::vector<uint8_t> rgb = tangent_space_map(image, tangents, bumpy);
    for (size_t s = 0; s < size_t{33} * 33; ++s) {
        const Vec3 n(image.grid_normals[3 * s], image.grid_normals[3 * s + 1], image.grid_normals[3 * s + 2]);
        const Vec3 t(tangents[4 * s], tangents[4 * s + 1], tangents[4 * s + 2]);
        EXPECT_NEAR(n.dot(t), 0, 1e-5);
        EXPECT_EQ(tangents[4 * s + 3], -1);
        const Vec3 b = n.cross(t) * static_cast<double>(tangents[4 * s + 3]);
        const Vec3 seen =
            (rgb[3 * s] / 127.5 - 1) * t + (rgb[3 * s + 1] / 127.5 - 1) * b + (rgb[3 * s + 2] / 127.5 - 1) * n;
        const Vec3 wanted(bumpy.values[3 * s], bumpy.values[3 * s + 1], bumpy.values[3 * s + 2]);
        EXPECT_GT(seen.normalized().dot(wanted), 0.9998) << s;
    }
}

TEST(Planes, SixteenBitPngHoldsTheNormals) {
    ImagePlane plane{5, 5, {}};
    for (int i = 0; i < 25; ++i)
        for (const float v : {-1.0f, 1.0f, static_cast<float>(i) / 25}) plane.values.push_back(v);
    const Result<Bytes> png = write_normal_png(plane);
    ASSERT_TRUE(png.ok());
    EXPECT_EQ(png.value()[24], 16);  // bits of a sample
    const DecodedPicture picture = decode_picture(png.value());
    ASSERT_EQ(picture.width, 5u);
    ASSERT_EQ(picture.rgb.size(), 75u);
    for (size_t i = 0; i < 75; i += 3) {
        EXPECT_EQ(picture.rgb[i], 0);
        EXPECT_EQ(picture.rgb[i + 1], 255);
        EXPECT_NEAR(picture.rgb[i + 2], 127.5 * (1 + double(i) / 75), 1);
    }
}

// A sphere whose colours are 128 + 100 * its coordinates.
void save_colored_sphere(const std::string& path) {
    TriangleMesh mesh = corpus::sphere(8);
    std::string ply =
        "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
        "property uchar blue\nelement face " +
        std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const auto& p : mesh.positions) {
        for (const double x : p) ply += std::to_string(x) + " ";
        for (const double x : p) ply += std::to_string(static_cast<int>(128 + 100 * x)) + " ";
        ply += "\n";
    }
    for (const auto& t : mesh.triangles)
        ply += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
    save(path, ply);
}

int run(std::vector<std::string> words) {
    words.insert(words.begin(), "gim");
    std::vector<const char*> argv;
    for (const std::string& w : words) argv.push_back(w.c_str());
    return run_gim(static_cast<int>(argv.size()), argv.data());
}

// Reads the colour at a point of that sphere.
void expect_color_of_the_sphere(const std::string& path) {
    SCOPED_TRACE(path);
    const Input back = read_colored(path);
    EXPECT_TRUE(back.warnings.empty());
    ASSERT_FALSE(back.mesh.appearance.empty());
    const std::vector<Vec3> point = {Vec3(0.6, 0, 0.8)};
    const std::vector<float> color = InputColors(back.mesh).at(point);
    EXPECT_NEAR(color[0], 188, 6);
    EXPECT_NEAR(color[1], 128, 6);
    EXPECT_NEAR(color[2], 208, 6);
}

TEST(Planes, TheWholeWayThroughTheProgram) {
    TemporaryFolder folder;
    save_colored_sphere(folder.file("in.ply"));
    const std::string gim = folder.file("a.gim"), plain = folder.file("plain.gim");
    ASSERT_EQ(run({"encode", folder.file("in.ply"), gim, "--size", "33", "--normals", "100", "--json",
                   folder.file("r.json"), "--quiet"}),
              0);
    const auto report = nlohmann::json::parse(test::load_text(folder.file("r.json")));
    ASSERT_EQ(report["planes"].size(), 2u);
    EXPECT_EQ(report["planes"][0]["width"], 129);
    EXPECT_GT(report["planes"][1]["psnr"], 35);
    ASSERT_EQ(run({"decode", gim, folder.file("o.obj"), "--normal-map", folder.file("n.png"), "--color-map",
                   folder.file("c.png")}),
              0);
    ASSERT_EQ(read_colored(folder.file("o.obj")).mesh.appearance.textures.size(), 1u);
    expect_color_of_the_sphere(folder.file("o.obj"));
    ASSERT_EQ(run({"decode", gim, folder.file("o.exr"), "--normal-map", folder.file("n.exr"), "--color-map",
                   folder.file("c.exr")}),
              0);
    EXPECT_EQ(run({"info", gim}), 0);

    ASSERT_EQ(run({"encode", folder.file("in.ply"), plain, "--size", "33", "--colors", "0", "--quiet"}), 0);
    const auto before = folder.names();
    EXPECT_EQ(run({"decode", plain, folder.file("new.ply"), "--color-map", folder.file("new.png")}), 1);
    EXPECT_EQ(folder.names(), before);
    EXPECT_EQ(run({"decode", gim, folder.file("new.ply"), "--normal-map", folder.file("new.jpg")}), 2);
}

TEST(Planes, TilesBringThemToEveryFormat) {
    TemporaryFolder folder;
    save_colored_sphere(folder.file("in.ply"));
    const std::string gim = folder.file("a.gim");
    ASSERT_EQ(run({"encode", folder.file("in.ply"), gim, "--layout", "tiles", "--tiles", "20", "--size", "33",
                   "--normals", "100", "--json", folder.file("r.json"), "--quiet"}),
              0);
    const auto report = nlohmann::json::parse(test::load_text(folder.file("r.json")));
    ASSERT_EQ(report["planes"].size(), 2u);
    EXPECT_GT(report["planes"][1]["psnr"], 35);
    ASSERT_EQ(run({"decode", gim, folder.file("o.obj"), "--normal-map", folder.file("n.png"), "--color-map",
                   folder.file("c.png")}),
              0);
    for (const char* name : {"o.ply", "o.glb"}) ASSERT_EQ(run({"decode", gim, folder.file(name)}), 0);
    for (const char* name : {"o.obj", "o.ply", "o.glb"}) expect_color_of_the_sphere(folder.file(name));
    const DecodedPicture colors = decode_picture(to_bytes(test::load_text(folder.file("c.png"))));
    EXPECT_EQ(colors.width, report["planes"][1]["width"]);
    EXPECT_EQ(colors.height, report["planes"][1]["height"]);
    EXPECT_EQ(run({"info", gim}), 0);
}

}  // namespace
}  // namespace gim
