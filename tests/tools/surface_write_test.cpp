#include "tools/surface_write.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/tools/test_files.h"
#include "tools/mesh_read.h"

namespace gim {
namespace {

using test::TemporaryFolder;
using test::torus_image;

std::vector<DecodedImage> one_torus() { return {torus_image(9)}; }
std::vector<DecodedImage> two_tori() { return {torus_image(9), torus_image(5, 10)}; }

constexpr std::array<std::pair<SurfaceFormat, MeshFormat>, 3> kIndexedFormats = {
    {{SurfaceFormat::kPly, MeshFormat::kPly},
     {SurfaceFormat::kObj, MeshFormat::kObj},
     {SurfaceFormat::kOff, MeshFormat::kOff}}};

TriangleMesh read_back(const Bytes& bytes, MeshFormat format) {
    ReadContext context;
    const Result<TriangleMesh> mesh = read_mesh(bytes, format, context);
    EXPECT_TRUE(mesh.ok()) << mesh.error().message;
    return mesh.ok() ? mesh.value() : TriangleMesh{};
}

// Text holds the shortest decimal form of a float. Read as a double it is not quite that float.
std::vector<std::array<float, 3>> as_floats(const TriangleMesh& mesh) {
    std::vector<std::array<float, 3>> floats;
    for (const auto& p : mesh.positions) {
        floats.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    }
    return floats;
}

std::vector<std::array<std::array<double, 3>, 3>> corners(const TriangleMesh& mesh) {
    std::vector<std::array<std::array<double, 3>, 3>> all;
    for (const auto& t : mesh.triangles)
        all.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
    return all;
}

TEST(SurfaceWrite, IndexedFormatsGiveBackTheSameFloatsAndShareVertices) {
    for (const std::vector<DecodedImage>& images : {one_torus(), two_tori()}) {
        const TriangleMesh expected = to_mesh(images);
        for (const auto& [output, input] : kIndexedFormats) {
            const Result<Bytes> bytes = write_surface(output, images);
            ASSERT_TRUE(bytes.ok());
            const TriangleMesh mesh = read_back(bytes.value(), input);
            EXPECT_TRUE(as_floats(mesh) == as_floats(expected)) << format_name(input);
            EXPECT_EQ(mesh.triangles, expected.triangles) << format_name(input);
            const TopologySummary topology = summarize_topology(mesh);
            EXPECT_TRUE(topology.watertight) << format_name(input);
            EXPECT_EQ(topology.genus, static_cast<double>(images.size()));
        }
    }
}

TEST(SurfaceWrite, StlAndGlbCloseWhenEqualPositionsAreJoined) {
    const std::vector<DecodedImage> images = two_tori();
    const auto expected = corners(to_mesh(images));
    for (const auto& [output, input] :
         {std::pair{SurfaceFormat::kStl, MeshFormat::kStl}, std::pair{SurfaceFormat::kGlb, MeshFormat::kGltf}}) {
        const Result<Bytes> bytes = write_surface(output, images);
        ASSERT_TRUE(bytes.ok());
        const TriangleMesh mesh = read_back(bytes.value(), input);
        EXPECT_EQ(corners(mesh), expected) << format_name(input);
        EXPECT_TRUE(summarize_topology(weld_equal_positions(mesh)).watertight) << format_name(input);
    }
    const Result<Bytes> fused = write_surface(SurfaceFormat::kGlb, images, {.fused = true});
    ASSERT_TRUE(fused.ok());
    EXPECT_TRUE(summarize_topology(read_back(fused.value(), MeshFormat::kGltf)).watertight);
}

TEST(SurfaceWrite, ObjTextureCoordinatesDoNotJumpInsideATriangle) {
    const Bytes bytes = write_obj(one_torus());
    std::vector<std::array<double, 2>> uv;
    size_t faces = 0;
    for (size_t begin = 0; begin < bytes.size();) {
        const auto newline = std::find(bytes.begin() + static_cast<std::ptrdiff_t>(begin), bytes.end(), '\n');
        const std::string line(bytes.begin() + static_cast<std::ptrdiff_t>(begin), newline);
        begin += line.size() + 1;
        std::array<double, 2> t = {};
        if (std::sscanf(line.c_str(), "vt %lf %lf", t.data(), &t[1]) == 2) uv.push_back(t);
        std::array<size_t, 9> f = {};
        if (std::sscanf(line.c_str(), "f %zu/%zu/%zu %zu/%zu/%zu %zu/%zu/%zu", f.data(), &f[1], &f[2], &f[3], &f[4],
                        &f[5], &f[6], &f[7], &f[8]) != 9) {
            continue;
        }
        ++faces;
        for (size_t k = 0; k < 2; ++k) {
            EXPECT_LE(std::abs(uv.at(f[1] - 1)[k] - uv.at(f[4] - 1)[k]), 1.0 / 8);
            EXPECT_LE(std::abs(uv.at(f[1] - 1)[k] - uv.at(f[7] - 1)[k]), 1.0 / 8);
        }
    }
    EXPECT_EQ(uv.size(), 81U);
    EXPECT_EQ(faces, 128U);
}

// Checks what the glTF specification asks of the container and of accessors.
TEST(SurfaceWrite, GlbKeepsTheRulesOfTheSpecification) {
    const Result<Bytes> written = write_surface(SurfaceFormat::kGlb, two_tori());
    ASSERT_TRUE(written.ok());
    const Bytes& glb = written.value();
    const auto word = [&](size_t offset) {
        uint32_t value = 0;
        std::memcpy(&value, glb.data() + offset, 4);
        return value;
    };
    EXPECT_EQ(word(0), 0x46546C67U);
    EXPECT_EQ(word(4), 2U);
    EXPECT_EQ(word(8), glb.size());
    const uint32_t json_size = word(12);
    EXPECT_EQ(json_size % 4, 0U);
    EXPECT_EQ(word(16), 0x4E4F534AU);
    const size_t binary = 20 + json_size + 8;
    EXPECT_EQ(word(binary - 8), glb.size() - binary);
    EXPECT_EQ(word(binary - 4), 0x004E4942U);

    const auto document = nlohmann::json::parse(glb.begin() + 20, glb.begin() + 20 + json_size);
    EXPECT_EQ(document["asset"]["version"], "2.0");
    EXPECT_EQ(document["buffers"][0]["byteLength"], glb.size() - binary);
    for (const auto& mesh : document["meshes"]) {
        const auto& primitive = mesh["primitives"][0];
        const auto& points = document["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
        const auto& normals = document["accessors"][primitive["attributes"]["NORMAL"].get<size_t>()];
        const auto& texcoords = document["accessors"][primitive["attributes"]["TEXCOORD_0"].get<size_t>()];
        const auto& indices = document["accessors"][primitive["indices"].get<size_t>()];
        EXPECT_EQ(points["count"], normals["count"]);
        EXPECT_EQ(points["count"], texcoords["count"]);

        const auto floats = [&](const nlohmann::json& accessor, size_t i) {
            const size_t offset = document["bufferViews"][accessor["bufferView"].get<size_t>()]["byteOffset"];
            EXPECT_EQ(offset % 4, 0U);
            float value = 0;
            std::memcpy(&value, glb.data() + binary + offset + 4 * i, 4);
            return static_cast<double>(value);
        };
        std::array<double, 3> low = {1e30, 1e30, 1e30};
        std::array<double, 3> high = {-1e30, -1e30, -1e30};
        for (size_t i = 0; i < 3 * points["count"].get<size_t>(); ++i) {
            low[i % 3] = std::min(low[i % 3], floats(points, i));
            high[i % 3] = std::max(high[i % 3], floats(points, i));
        }
        EXPECT_EQ(points["min"].get<std::vector<double>>(), std::vector<double>(low.begin(), low.end()));
        EXPECT_EQ(points["max"].get<std::vector<double>>(), std::vector<double>(high.begin(), high.end()));
        for (size_t i = 0; i < normals["count"].get<size_t>(); ++i) {
            const double squared = floats(normals, 3 * i) * floats(normals, 3 * i) +
                                   floats(normals, 3 * i + 1) * floats(normals, 3 * i + 1) +
                                   floats(normals, 3 * i + 2) * floats(normals, 3 * i + 2);
            EXPECT_NEAR(squared, 1, 1e-5);
        }
        EXPECT_EQ(indices["componentType"], 5125);
        EXPECT_EQ(indices["count"].get<size_t>() % 3, 0U);
    }
}

TEST(SurfaceWrite, GlbHasNoZeroNormals) {
    std::vector<DecodedImage> images = one_torus();
    std::fill_n(images[0].grid_normals.begin(), 3, 0.0F);
    const Result<Bytes> written = write_surface(SurfaceFormat::kGlb, images);
    ASSERT_TRUE(written.ok());
    const std::string text(written.value().begin(), written.value().end());
    const std::array<float, 3> up = {0, 0, 1};
    EXPECT_NE(text.find(std::string(reinterpret_cast<const char*>(up.data()), sizeof(up))), std::string::npos);
}

TEST(SurfaceWrite, StlHeaderIsNotMistakenForText) {
    const Bytes bytes = write_stl(one_torus());
    EXPECT_EQ(bytes.size(), 84U + 50U * 128U);
    EXPECT_NE(std::string(bytes.begin(), bytes.begin() + 5), "solid");
}

void expect_exr_plane(Imf::InputPart& part, const std::string& channel, const DecodedImage& image, size_t k) {
    std::vector<float> plane(size_t{image.columns} * image.columns, -1.0F);
    Imf::FrameBuffer frame;
    frame.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(plane.data()), sizeof(float),
                                     image.columns * sizeof(float)));
    part.setFrameBuffer(frame);
    part.readPixels(0, static_cast<int>(image.columns) - 1);
    for (size_t i = 0; i < plane.size(); ++i) {
        ASSERT_EQ(plane[i], k < 3 ? image.grid[3 * i + k] : 1.0F) << channel << " " << i;
    }
}

TEST(SurfaceWrite, PositionsRelativeToAnOriginAreDoublesWhereAFormatHasThem) {
    std::vector<DecodedImage> images = two_tori();
    for (DecodedImage& image : images) image.origin = {500000.1, -4000000.3, 1e9 / 3};
    const TriangleMesh expected = to_mesh(images);
    EXPECT_EQ(expected.positions[0][0], 500000.1 + double{images[0].positions[0]});
    for (const auto& [output, input] : kIndexedFormats) {
        const Result<Bytes> bytes = write_surface(output, images);
        ASSERT_TRUE(bytes.ok());
        const TriangleMesh mesh = read_back(bytes.value(), input);
        EXPECT_TRUE(mesh.positions == expected.positions) << format_name(input);
        EXPECT_EQ(mesh.triangles, expected.triangles) << format_name(input);
        EXPECT_EQ(rounding_warning(output, images), "");
    }
    for (const bool fused : {false, true}) {
        const Result<Bytes> glb = write_surface(SurfaceFormat::kGlb, images, {.fused = fused});
        ASSERT_TRUE(glb.ok());
        EXPECT_TRUE(corners(read_back(glb.value(), MeshFormat::kGltf)) == corners(expected));
    }
    EXPECT_EQ(rounding_warning(SurfaceFormat::kGlb, images), "");
    EXPECT_NE(rounding_warning(SurfaceFormat::kStl, images).find("rounded by up to 1"), std::string::npos)
        << rounding_warning(SurfaceFormat::kStl, images);
    EXPECT_NE(rounding_warning(SurfaceFormat::kExr, images).find("gimOrigin, 500000.1 -4000000.3"), std::string::npos)
        << rounding_warning(SurfaceFormat::kExr, images);
    for (const SurfaceFormat format : {SurfaceFormat::kStl, SurfaceFormat::kExr})
        EXPECT_EQ(rounding_warning(format, two_tori()), "");
}

TEST(SurfaceWrite, ExrHoldsTheSamplesBitForBit) {
    const TemporaryFolder folder;
    for (const std::vector<DecodedImage>& images : {one_torus(), two_tori()}) {
        const Result<Bytes> bytes = write_surface(SurfaceFormat::kExr, images);
        ASSERT_TRUE(bytes.ok()) << bytes.error().message;
        const std::string path = folder.file("image.exr");
        ASSERT_TRUE(write_file(path, bytes.value()).ok());
        Imf::MultiPartInputFile file(path.c_str());
        ASSERT_EQ(file.parts(), static_cast<int>(images.size()));
        for (int p = 0; p < file.parts(); ++p) {
            Imf::InputPart part(file, p);
            const DecodedImage& image = images[static_cast<size_t>(p)];
            EXPECT_EQ(part.header().dataWindow().max.x, static_cast<int>(image.columns) - 1);
            for (const char* name : {"X", "Y", "Z", "mask"}) {
                const Imf::Channel* channel = part.header().channels().findChannel(name);
                ASSERT_NE(channel, nullptr) << name;
                EXPECT_EQ(channel->type, Imf::FLOAT);
            }
            expect_exr_plane(part, "X", image, 0);
            expect_exr_plane(part, "Y", image, 1);
            expect_exr_plane(part, "Z", image, 2);
            expect_exr_plane(part, "mask", image, 3);
        }
    }
}

}  // namespace
}  // namespace gim
