#include "tools/mesh_read.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/tools/gltf_builder.h"
#include "tests/tools/test_files.h"

namespace gim {
namespace {

using test::to_bytes;

Result<TriangleMesh> read(std::string_view content, std::string_view extension) {
    const Bytes bytes = to_bytes(content);
    ReadContext context;
    return read_mesh(bytes, detect_format(bytes, extension), context);
}

std::string message(std::string_view content, std::string_view extension) {
    const Result<TriangleMesh> mesh = read(content, extension);
    return mesh.ok() ? "(was read)" : mesh.error().message;
}

// Two triangles that share an edge, a third on the same edge, one degenerate and one repeated. A half-edge structure
// could not keep them all.
const std::vector<std::array<double, 3>> kPositions = {
    {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 4300000.125}, {0.1, 0.2, 0.3}};
const std::vector<std::array<uint32_t, 3>> kTriangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {2, 2, 3}, {0, 1, 2}};

const std::string kPlyHeader =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\nproperty double x\nproperty double y\n"
    "property double z\nelement face 5\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kAsciiPly = kPlyHeader +
                              "0 0 0\n1 0 0\n0 1 0\n0 0 4300000.125\n0.1 0.2 0.3\n"
                              "3 0 1 2\n3 1 0 3\n3 0 1 4\n3 2 2 3\n3 0 1 2\n";
const std::string kObj =
    "# by hand\nmtllib none.mtl\nv 0 0 0\nv 1 0 0\nvt 0 0\nvn 0 0 1\nv 0 1 0\nv 0 0 4300000.125 1.0\nv .1 2e-1 +0.3\n"
    "g part\nf 1 2 3\nf 2/1/1 1/1 4//1\nf -5 -4 -1\nf 3 3 4\nf 1 2 \\\n 3\n";
const std::string kOff =
    "OFF # by hand\n# a comment\n5 5 0\n0 0 0\n1 0 0\n0 1 0\n\n0 0 4300000.125\n0.1 0.2 0.3\n"
    "3 0 1 2 255 0 0\n3 1 0 3\n3 0 1 4\n3 2 2 3\n3 0 1 2\n";

template <class T>
void put(std::string& out, T value, bool big_endian = false) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big_endian) std::reverse(bytes, bytes + sizeof(T));
    out.append(bytes, sizeof(T));
}

std::string binary_ply(bool big_endian) {
    // Unknown properties, lists and elements stand between those that we want.
    std::string out = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                      "_endian 1.0\nelement camera 1\nproperty list ushort short mystery\nelement vertex 5\n"
                      "property uchar red\nproperty double x\nproperty double y\nproperty double z\nelement face 5\n"
                      "property list uchar float texcoord\nproperty list uint ushort vertex_index\nend_header\n";
    put<uint16_t>(out, 2, big_endian);
    put<int16_t>(out, 7, big_endian);
    put<int16_t>(out, -7, big_endian);
    for (const auto& p : kPositions) {
        put<uint8_t>(out, 200);
        for (const double x : p) put(out, x, big_endian);
    }
    for (const auto& t : kTriangles) {
        put<uint8_t>(out, 1);
        put(out, 0.5F, big_endian);
        put<uint32_t>(out, 3, big_endian);
        for (const uint32_t v : t) put(out, static_cast<uint16_t>(v), big_endian);
    }
    return out;
}

std::string binary_stl(uint32_t claimed, uint32_t facets) {
    std::string out = "solid but binary";
    out.resize(80, ' ');
    put(out, claimed);
    for (uint32_t f = 0; f < facets; ++f) {
        for (int i = 0; i < 12; ++i) put(out, i < 3 ? 0.0F : static_cast<float>(i) + static_cast<float>(f));
        put<uint16_t>(out, 0);
    }
    return out;
}

const std::string kAsciiStl =
    "solid a name outer vertex\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1e0 0\n"
    " endloop\nendfacet\nFACET NORMAL 0 0 1\n OUTER LOOP\n  VERTEX 0 0 0\n  VERTEX 0 0 0\n  VERTEX 0 1 0\n ENDLOOP\n"
    "ENDFACET\nendsolid a name\n";

TEST(MeshRead, EveryFormatKeepsVerticesAndFacesInFileOrder) {
    for (const auto& [content, extension] : std::vector<std::pair<std::string, std::string>>{
             {kAsciiPly, "ply"}, {kObj, "obj"}, {kOff, "off"}, {binary_ply(false), "ply"}, {binary_ply(true), "ply"}}) {
        const Result<TriangleMesh> mesh = read(content, extension);
        ASSERT_TRUE(mesh.ok()) << extension << ": " << mesh.error().message;
        EXPECT_EQ(mesh.value().positions, kPositions) << extension;
        EXPECT_EQ(mesh.value().triangles, kTriangles) << extension;
    }
}

TEST(MeshRead, StlKeepsEveryFacetAlsoDegenerateOnes) {
    const Result<TriangleMesh> ascii = read(kAsciiStl, "stl");
    ASSERT_TRUE(ascii.ok()) << ascii.error().message;
    EXPECT_EQ(ascii.value().positions.size(), 6U);
    EXPECT_EQ(ascii.value().triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {3, 4, 5}}));

    const Result<TriangleMesh> binary = read(binary_stl(4, 4), "stl");
    ASSERT_TRUE(binary.ok()) << binary.error().message;
    EXPECT_EQ(binary.value().triangles.size(), 4U);
    EXPECT_EQ(binary.value().positions[3], (std::array<double, 3>{4, 5, 6}));
}

TEST(MeshRead, ContentDecidesWhereTheExtensionLies) {
    EXPECT_TRUE(read(kAsciiPly, "stl").ok());
    EXPECT_TRUE(read(kObj, "ply").ok());
    EXPECT_TRUE(read(kOff, "").ok());
    EXPECT_TRUE(read(kAsciiStl, "obj").ok());
    EXPECT_TRUE(read(binary_stl(2, 2), "off").ok());
}

TEST(MeshRead, NonFiniteCoordinatesAreKept) {
    std::string ply = kAsciiPly;
    ply.replace(ply.find("\n1 0 0"), 6, "\n1 NaN -inf");
    const Result<TriangleMesh> from_ply = read(ply, "ply");
    ASSERT_TRUE(from_ply.ok()) << from_ply.error().message;
    EXPECT_TRUE(std::isnan(from_ply.value().positions[1][1]));
    EXPECT_EQ(from_ply.value().positions[1][2], -std::numeric_limits<double>::infinity());
    EXPECT_EQ(from_ply.value().triangles, kTriangles);

    const Result<TriangleMesh> from_obj = read("v 0 0 0\nv 1 1.#QNAN 0\nv 0 1 0\nf 1 2 3\n", "obj");
    ASSERT_TRUE(from_obj.ok()) << from_obj.error().message;
    EXPECT_TRUE(std::isnan(from_obj.value().positions[1][1]));
    EXPECT_TRUE(read("OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "off").ok());
}

TEST(MeshRead, PolygonsBecomeTrianglesInsideTheirOutline) {
    // An arrowhead: the fan from corner 0 would leave it.
    const Result<TriangleMesh> arrow = read("v 0 3 0\nv -2 -1 0\nv 0 0 0\nv 2 -1 0\nf 2 3 4 1\n", "obj");
    ASSERT_TRUE(arrow.ok());
    ASSERT_EQ(arrow.value().triangles.size(), 2U);
    double area = 0;
    for (const auto& t : arrow.value().triangles) {
        const auto& a = arrow.value().positions[t[0]];
        const auto& b = arrow.value().positions[t[1]];
        const auto& c = arrow.value().positions[t[2]];
        const double doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        EXPECT_GT(doubled, 0);
        area += doubled / 2;
    }
    EXPECT_DOUBLE_EQ(area, 6);

    std::string circle = "OFF\n300 1 0\n";
    for (int i = 0; i < 300; ++i) {
        circle += std::to_string(std::cos(i * 0.02)) + " " + std::to_string(std::sin(i * 0.02)) + " 0\n";
    }
    circle += "300";
    for (int i = 0; i < 300; ++i) circle += " " + std::to_string(i);
    const Result<TriangleMesh> many = read(circle + "\n", "off");
    ASSERT_TRUE(many.ok());
    EXPECT_EQ(many.value().triangles.size(), 298U);
}

TEST(MeshRead, StripsAlternateTheirOrientation) {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 2 1 0\n";
    const Result<TriangleMesh> mesh = read(ply, "ply");
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    EXPECT_EQ(mesh.value().triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {2, 1, 3}, {2, 1, 0}}));
}

TEST(MeshRead, EmptyFilesAndOtherTextsAreNamedAsSuch) {
    for (const char* extension : {"ply", "obj", "off", "stl", "glb", "gltf", ""}) {
        EXPECT_NE(message("", extension).find("not a mesh that gim can read: the file is empty"), std::string::npos);
        const std::string text = message("Dear all,\nthis is a letter and no mesh.\n", extension);
        EXPECT_EQ(text.find("not a mesh that gim can read: "), 0U) << extension << ": " << text;
    }
}

TEST(MeshRead, ClaimsBeyondTheFileAreRefusedBeforeMemoryIsTaken) {
    const std::string vertex = "property float x\nproperty float y\nproperty float z\n";
    const std::string face = "element face 2000000000\nproperty list uchar int vertex_indices\nend_header\n";
    for (const std::string format : {"ascii", "binary_little_endian"}) {
        const std::string start = "ply\nformat " + format + " 1.0\nelement vertex ";
        EXPECT_NE(message(start + "2000000000\n" + vertex + face, "ply").find("claims 2000000000"), std::string::npos);
        EXPECT_NE(message(start + "0\n" + vertex + face, "ply").find("claims 2000000000"), std::string::npos);
    }
    const std::string list = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + vertex +
                             "element face 1\nproperty list uint int vertex_indices\nend_header\n";
    EXPECT_NE(message(list + std::string(12, '\0') + std::string(4, '\x7f'), "ply").find("cut short"),
              std::string::npos);
    EXPECT_NE(message("OFF\n2000000000 2000000000 0\n0 0 0\n", "off").find("claims 2000000000"), std::string::npos);
    EXPECT_NE(message("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n", "off").find("fewer vertices"),
              std::string::npos);
    EXPECT_NE(message(binary_stl(2000000000, 0) + std::string(16, '\0'), "stl").find("claims 2000000000"),
              std::string::npos);
    std::string glb = "glTF";
    put<uint32_t>(glb, 2);
    put<uint32_t>(glb, 2000000000);
    put<uint32_t>(glb, 1900000000);
    glb += "JSON" + std::string(84, ' ');
    EXPECT_EQ(message(glb, "glb").find("not a mesh that gim can read: "), 0U);
}

TEST(MeshRead, EveryTruncationIsRefusedOrStillWhole) {
    // A text may lose its last newline, or a digit of its last number, but nothing before that.
    for (const auto& [content, extension, harmless] :
         std::vector<std::tuple<std::string, std::string, size_t>>{{kAsciiPly, "ply", 1},
                                                                   {kOff, "off", 1},
                                                                   {binary_ply(false), "ply", 0},
                                                                   {binary_ply(true), "ply", 0},
                                                                   {kAsciiStl, "stl", 8},
                                                                   {binary_stl(3, 3), "stl", 0}}) {
        for (size_t size = 0; size + harmless < content.size(); ++size) {
            EXPECT_FALSE(read(content.substr(0, size), extension).ok()) << extension << " cut at " << size;
        }
        EXPECT_TRUE(read(content, extension).ok());
    }
}

TEST(MeshRead, BadIndicesAreNamed) {
    std::string ply = kAsciiPly;
    ply.replace(ply.find("3 1 0 3"), 7, "3 1 0 9");
    EXPECT_NE(message(ply, "ply").find("face 1 uses vertex 9"), std::string::npos) << message(ply, "ply");
    EXPECT_NE(message("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 7\n", "obj").find("vertex 6"), std::string::npos);
    EXPECT_NE(message("v 0 0 0\nf 1 1 0\n", "obj").find("line 2"), std::string::npos);
    EXPECT_NE(message("v 0 0 0\nf 1 1 -5\n", "obj").find("vertex -4"), std::string::npos);
    EXPECT_NE(message("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "off").find("vertex 3"), std::string::npos);
}

TEST(MeshRead, PointCloudsAreRefused) {
    EXPECT_NE(message("v 0 0 0\nv 1 0 0\n", "obj").find("no faces"), std::string::npos);
    EXPECT_NE(message("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "off").find("three corners"), std::string::npos);
}

// ---- glTF -----------------------------------------------------------------------------------------------------------

// Four points of a square, indices 0 1 2 3 as bytes.
std::string gltf(const std::string& mode, const std::string& node, uint32_t index_count = 4) {
    std::string buffer;
    for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 1.F, 1.F, 0.F}) put(buffer, x);
    buffer += std::string("\0\1\2\3", 4);
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],)" + node +
           R"(},{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":)" + mode +
           R"(}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)" +
           R"({"bufferView":1,"componentType":5121,"count":)" + std::to_string(index_count) +
           R"(,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},)" +
           R"({"buffer":0,"byteOffset":48,"byteLength":4}],"buffers":[{"byteLength":52,"uri":)" +
           R"("data:application/octet-stream;base64,)" + test::base64(buffer) + "\"}]}";
}

TEST(MeshRead, GltfAppliesNodeTransformsAndKeepsMirroredFacesOutward) {
    const Result<TriangleMesh> moved = read(gltf("5", R"("translation":[10,0,0],"scale":[2,2,2])"), "gltf");
    ASSERT_TRUE(moved.ok()) << moved.error().message;
    EXPECT_EQ(moved.value().positions[1], (std::array<double, 3>{12, 0, 0}));
    EXPECT_EQ(moved.value().triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {2, 1, 3}}));

    const Result<TriangleMesh> mirrored = read(gltf("6", R"("scale":[-1,1,1])"), "gltf");
    ASSERT_TRUE(mirrored.ok()) << mirrored.error().message;
    EXPECT_EQ(mirrored.value().triangles, (std::vector<std::array<uint32_t, 3>>{{0, 2, 1}, {0, 3, 2}}));

    const Result<TriangleMesh> turned =
        read(gltf("4", R"("rotation":[0,0,0.70710678118654752,0.70710678118654752])"), "gltf");
    ASSERT_TRUE(turned.ok()) << turned.error().message;
    EXPECT_NEAR(turned.value().positions[1][1], 1, 1e-12);
    EXPECT_EQ(turned.value().triangles.size(), 1U);
}

TEST(MeshRead, GltfThatReachesBeyondItsBufferIsRefused) {
    EXPECT_NE(message(gltf("4", R"("name":"n")", 5), "gltf").find("beyond its buffer"), std::string::npos);
    EXPECT_NE(message(gltf("4", R"("name":"n")", 2000000000), "gltf").find("beyond its buffer"), std::string::npos);
    std::string cycle = gltf("4", R"("name":"n")");
    cycle.replace(cycle.find(R"({"mesh":0})"), 10, R"({"children":[0],"mesh":0})");
    EXPECT_NE(message(cycle, "gltf").find("too deeply"), std::string::npos);
}

TEST(MeshRead, EqualPositionsAreWeldedInOrder) {
    const TriangleMesh soup = {{{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, -0.0, 0}, {1, 0, 0}, {0, 0, 1}},
                               {{0, 1, 2}, {3, 4, 5}}};
    const TriangleMesh welded = weld_equal_positions(soup);
    EXPECT_EQ(welded.positions, (std::vector<std::array<double, 3>>{{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(welded.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {1, 0, 3}}));
}

TEST(MeshRead, WeldingAnEdgeOfLengthZeroKeepsTheSurfaceClosed) {
    // An octahedron whose top vertex is split into two at the same place, with two slivers between them.
    const TriangleMesh split = {
        {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, -1}},
        {{0, 1, 4}, {1, 5, 4}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {3, 0, 4}, {1, 0, 6}, {2, 1, 6}, {3, 2, 6}, {0, 3, 6}}};
    ASSERT_TRUE(summarize_topology(split).watertight);
    const TriangleMesh welded = weld_equal_positions(split);
    EXPECT_EQ(welded.triangles.size(), 8U);
    EXPECT_TRUE(summarize_topology(welded).watertight);
}

}  // namespace
}  // namespace gim
