// Dialects of the formats: what the programs that write meshes do, rightly or not.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/tools/test_files.h"
#include "tools/foreign_format.h"
#include "tools/mesh_read.h"
#include "tools/stb.h"

namespace gim {
namespace {

using test::save;
using test::TemporaryFolder;
using test::to_bytes;

using Color = std::array<float, 3>;

const std::string kNoBreakSpace = "\xC2\xA0";

struct Read {
    Result<TriangleMesh> mesh;
    std::vector<std::string> warnings;
};

Read read_from(const std::string& folder, std::string_view content, std::string_view extension) {
    const Bytes bytes = to_bytes(content);
    Textures textures(folder);
    ReadContext context{folder, &textures};
    Result<TriangleMesh> mesh = read_mesh(bytes, detect_format(bytes, extension), context);
    return {std::move(mesh), context.warnings};
}

// The mesh, or a failure of the test.
TriangleMesh mesh_of(const Read& read, std::string_view content) {
    EXPECT_TRUE(read.mesh.ok()) << read.mesh.error().message << "\n" << content;
    return read.mesh.ok() ? read.mesh.value() : TriangleMesh{};
}
TriangleMesh read(std::string_view content, std::string_view extension) {
    return mesh_of(read_from("", content, extension), content);
}
std::string message(std::string_view content, std::string_view extension) {
    const Read result = read_from("", content, extension);
    return result.mesh.ok() ? "(was read)" : result.mesh.error().message;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

template <class T>
void put_big_endian(std::string& out, T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out.append(std::reverse_iterator(bytes + sizeof(T)), std::reverse_iterator(bytes));
}

// A tetrahedron in every text format.
const std::string kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n";
const std::string kPly = kPlyHead + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
const std::string kOff = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
const std::string kStl = "solid s\n" + kFacet + kFacet + "endsolid s\n";
const std::vector<std::pair<std::string, std::string>> kTexts = {
    {kPly, "ply"}, {kObj, "obj"}, {kOff, "off"}, {kStl, "stl"}};

std::string binary_stl(uint32_t claimed, uint32_t facets, const std::string& head = "solid in name only") {
    std::string out = head;
    out.resize(80, ' ');
    out.append(reinterpret_cast<const char*>(&claimed), 4);
    for (uint32_t f = 0; f < facets; ++f) {
        for (int i = 0; i < 12; ++i) {
            const float x = static_cast<float>(i * i) + static_cast<float>(f);
            out.append(reinterpret_cast<const char*>(&x), 4);
        }
        out += "\xFF\x7F";  // a colour
    }
    return out;
}

TEST(Dialects, LinesEndInThreeWaysAndBlanksAreMany) {
    for (const auto& [text, extension] : kTexts) {
        const TriangleMesh expected = read(text, extension);
        ASSERT_FALSE(expected.triangles.empty());
        const std::string longer = text + "\n";
        for (const std::string& variant :
             {replaced(text, "\n", "\r\n"), replaced(text, "\n", "\r"), "\xEF\xBB\xBF" + text,
              "\xEF\xBB\xBF" + replaced(text, "\n", "\r"), text + std::string(5, '\0'), text + "\x1A", text + "\n\n \n",
              replaced(text, " 0", "\t \f0"), replaced(text, " 0", kNoBreakSpace + "0"),
              replaced(text, " 0", kNoBreakSpace.substr(1) + "0"), text.substr(0, text.size() - 1)}) {
            const TriangleMesh mesh = read(variant, extension);
            EXPECT_EQ(mesh.positions, expected.positions) << variant;
            EXPECT_EQ(mesh.triangles, expected.triangles) << variant;
        }
    }
}

TEST(Dialects, PointsAndLinesAmongFacesAreLeftOutWithAWarning) {
    const std::vector<std::pair<std::string, std::string>> texts = {
        {replaced(kPlyHead, "face 4", "face 6") + kPly.substr(kPlyHead.size()) + "2 0 1\n1 3\n", "ply"},
        {kObj + "f 1 2\nf 3\n", "obj"},
        {replaced(kOff, "4 4 6", "4 6 6") + "2 0 1\n1 3\n", "off"}};
    for (const auto& [text, extension] : texts) {
        const Read result = read_from("", text, extension);
        EXPECT_EQ(mesh_of(result, text).triangles.size(), 4U) << text;
        ASSERT_EQ(result.warnings.size(), 1U) << text;
        EXPECT_NE(result.warnings[0].find("2 faces"), std::string::npos) << result.warnings[0];
    }
    EXPECT_NE(message(kObj + "f 1 2", "obj").find("cut short"), std::string::npos);
}

TEST(Dialects, WideTextIsNamed) {
    for (const auto& [text, extension] : kTexts) {
        std::string little, big;
        for (const char c : text) {
            little += {c, '\0'};
            big += {'\0', c};
        }
        for (const std::string& wide : {"\xFF\xFE" + little, "\xFE\xFF" + big, little, big}) {
            EXPECT_NE(message(wide, extension).find("UTF-16"), std::string::npos) << message(wide, extension);
        }
    }
}

TEST(Dialects, BinaryPlyMayBeginWithTheByteOfALineEnd) {
    // The first coordinate's first byte is LF, after a header whose lines end with CR alone or with CR LF.
    const float ten = std::bit_cast<float>(0x4120000Au);
    for (const std::string end : {"\r", "\n", "\r\n"}) {
        std::string text = replaced(replaced(kPlyHead, "ascii", "binary_little_endian"), "\n", end);
        text = replaced(replaced(text, "vertex 4", "vertex 3"), "face 4", "face 1");
        for (const float x : {ten, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f})
            text.append(reinterpret_cast<const char*>(&x), 4);
        text += '\3';
        for (const int i : {0, 1, 2}) text.append(reinterpret_cast<const char*>(&i), 4);
        EXPECT_EQ(read(text, "ply").positions.at(0)[0], static_cast<double>(ten)) << end.size();
    }
}

TEST(Dialects, NumbersComeInManyForms) {
    EXPECT_EQ(read(replaced(kObj, "v 1 0 0", "v +1.d0 0e0 -0"), "obj").positions.at(1)[0], 1);
    EXPECT_EQ(read(replaced(kOff, "\n1 0 0", "\n1D+2 0 0"), "off").positions.at(1)[0], 100);
    EXPECT_TRUE(std::isinf(read(replaced(kPly, "\n1 0 0", "\n1e400 0 0"), "ply").positions.at(1)[0]));
    EXPECT_EQ(read(replaced(kPly, "\n1 0 0", "\n1e-400 0 0"), "ply").positions.at(1)[0], 0);
    for (const std::string wrong : {"0x10", "1,5", "1.5e", "+-1", "1..2", "one"}) {
        EXPECT_NE(message(replaced(kObj, "v 1 0 0", "v " + wrong + " 0 0"), "obj").find(wrong), std::string::npos);
        EXPECT_NE(message(replaced(kOff, "\n1 0 0", "\n" + wrong + " 0 0"), "off").find(wrong), std::string::npos);
        EXPECT_NE(message(replaced(kPly, "\n1 0 0", "\n" + wrong + " 0 0"), "ply").find(wrong), std::string::npos);
        EXPECT_NE(message(replaced(kStl, "x 1 0 0", "x " + wrong + " 0 0"), "stl").find(wrong), std::string::npos);
    }
    for (const auto& [text, extension] : {std::pair{kObj, "obj"}, {kOff, "off"}, {kPly, "ply"}, {kStl, "stl"}}) {
        const std::string nan = replaced(replaced(text, " 1 0 0", " 1.#QNAN 0 0"), "\n1 0 0", "\n-1.#IND00 0 0");
        EXPECT_TRUE(std::isnan(read(nan, extension).positions.at(1)[0])) << nan;
    }
    EXPECT_NE(message(replaced(kObj, "v 1 0 0", "v 1,5 0 0"), "obj").find("decimal comma"), std::string::npos);
    EXPECT_NE(message(replaced(kObj, "f 1 3 2", "f 0x1 3 2"), "obj").find("0x1"), std::string::npos);
    EXPECT_NE(message(replaced(kObj, "f 1 3 2", "f 1 99999999999999999999 2"), "obj").find("line 5"),
              std::string::npos);
}

// ---- OBJ ------------------------------------------------------------------------------------------------------------

TEST(ObjDialects, BackslashesAndCommentsStandAnywhere) {
    const TriangleMesh expected = read(kObj, "obj");
    for (const std::string& variant :
         {replaced(kObj, "f 1 3 2", "f 1 \\\n3 2"), replaced(kObj, "f 1 3 2", "f 1 3\\\n 2"),
          replaced(kObj, "f 1 3 2", "f 1\\\r\n3\\ \r\n2"), replaced(kObj, "v 1 0 0", "v 1 \\\n 0 0"),
          replaced(kObj, "v 1 0 0", "v\\\n1 0 0"), replaced(kObj, "v 1 0 0", "v 1 0 0 # top"),
          replaced(kObj, "f 1 3 2", "f 1 3 2#first"), replaced(kObj, "f 1 3 2", "# C:\\\nf 1 3 2"),
          replaced(kObj, "f 1 3 2", "o a\\\n b\ng x # y\ns off\nf 1// 3// 2//"),
          replaced(kObj, "f 1 3 2", "vn 0 0 1\nf -4//1 -2//1 -3//-1"),
          replaced(kObj, "f 1 3 2", "l 1 2\np 1\nf 1/ 3/ 2/")}) {
        const TriangleMesh mesh = read(variant, "obj");
        EXPECT_EQ(mesh.positions, expected.positions) << variant;
        EXPECT_EQ(mesh.triangles, expected.triangles) << variant;
    }
}

TEST(ObjDialects, VertexColorsFollowTheCoordinatesOrW) {
    const Color expected = {0.5f, 0.25f, 0.75f};
    for (const std::string numbers : {"0.5 0.25 0.75", "1 0.5 0.25 0.75", "1.0 0.5 0.25 0.75 1", "0.5 0.25 0.75 1",
                                      "127.5 63.75 191.25", "1 127.5 63.75 191.25"}) {
        const TriangleMesh mesh = read(replaced(kObj, "\nf 1 3 2", "\nf 1 3 2 #"), "obj");
        std::string text;
        for (const char* vertex : {"v 0 0 0 ", "v 1 0 0 ", "v 0 1 0 "}) text += vertex + numbers + "\n";
        const TriangleMesh colored = read(text + "f 1 2 3\n", "obj");
        ASSERT_EQ(colored.appearance.corner_colors.size(), 1U) << numbers;
        EXPECT_EQ(colored.appearance.corner_colors[0][1], expected) << numbers;
    }
    EXPECT_TRUE(read("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n", "obj").appearance.empty());
    const Read mixed = read_from("", "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "obj");
    EXPECT_EQ(mixed.warnings.size(), 1U);
}

class ObjMaterials : public testing::Test {
  protected:
    ObjMaterials() {
        const std::vector<uint8_t> rgb = {200, 30, 30};
        const std::vector<uint8_t> png = png_bytes(rgb.data(), 1, 1);
        for (const char* name : {"red.png", "my red.png"})
            save(folder_.file(name), {reinterpret_cast<const char*>(png.data()), png.size()});
    }
    // Reads a mesh with these material lines before it. Returns how many textures its first face has.
    size_t textures(const std::string& lines, size_t warnings = 0) {
        const Read result = read_from(folder_.path(), lines + kObj, "obj");
        EXPECT_EQ(result.warnings.size(), warnings) << lines;
        const std::vector<uint32_t> textures = mesh_of(result, lines).appearance.triangle_texture;
        return textures.empty() || textures[0] == UINT32_MAX ? 0 : 1;
    }
    TemporaryFolder folder_;
};

TEST_F(ObjMaterials, NamesMayHoldBlanks) {
    save(folder_.file("my part.mtl"), "\xEF\xBB\xBFnewmtl dark red\r\n\tmap_Kd red.png\r\n");
    EXPECT_EQ(textures("mtllib my part.mtl\nusemtl dark red\n"), 1U);
    EXPECT_EQ(textures("mtllib  \"my part.mtl\" \nusemtl  dark red \n"), 1U);
    EXPECT_EQ(textures("mtllib my part.mtl # the part\nusemtl dark red # dark\n"), 1U);
    EXPECT_EQ(textures("usemtl dark red\nmtllib .\\my part.mtl\n"), 1U);
    save(folder_.file("b.mtl"), "newmtl b\nmap_Kd my red.png # red\n");
    EXPECT_EQ(textures("mtllib b.mtl my part.mtl\nusemtl dark red\n"), 1U);
    EXPECT_EQ(textures("mtllib my part.mtl b.mtl\nusemtl b\n"), 1U);
    EXPECT_EQ(textures("mtllib b.mtl\nmtllib my part.mtl\nusemtl dark red\n"), 1U);
    EXPECT_EQ(textures("mtllib b.mtl none.mtl\nusemtl b\n", 1), 1U);
    EXPECT_EQ(textures("mtllib b.mtl\nusemtl c\n", 1), 0U);
}

TEST_F(ObjMaterials, MapsHaveOptionsBeforeTheirName) {
    for (const std::string map :
         {"-s 1 1 1 my red.png", "-s 1 1 my red.png", "-o 0 -clamp on my red.png", "my red.png",
          "-blendu off -mm 0 1 \"my red.png\"", "C:\\art\\my red.png", "-o 0 0 0 -s 1 red.png"}) {
        save(folder_.file("m.mtl"), "newmtl m\nmap_Kd " + map + "\n");
        EXPECT_EQ(textures("mtllib m.mtl\nusemtl m\n"), 1U) << map;
    }
    save(folder_.file("m.mtl"), "newmtl m\nmap_Kd -s 2 2 1 red.png\n");
    EXPECT_EQ(textures("mtllib m.mtl\nusemtl m\n", 1), 1U);
}

TEST_F(ObjMaterials, PlainColorsCountWithoutATexture) {
    save(folder_.file("m.mtl"),
         "newmtl a\nKd 0.5 0.25 1\nnewmtl b\nKd 255 0 51 # bytes\nnewmtl c\nKd 0 0 0\nmap_Kd red.png\n");
    const Read result =
        read_from(folder_.path(),
                  "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n"
                  "usemtl c\nf 1 2 3\n",
                  "obj");
    EXPECT_TRUE(result.warnings.empty());
    const Appearance a = mesh_of(result, "").appearance;
    ASSERT_EQ(a.corner_colors.size(), 4U);
    EXPECT_EQ(a.corner_colors[0][0], (Color{1, 1, 1}));
    EXPECT_EQ(a.corner_colors[1][1], (Color{0.5f, 0.25f, 1}));
    EXPECT_EQ(a.corner_colors[2][2], (Color{1, 0, 0.2f}));
    EXPECT_EQ(a.corner_colors[3][0], (Color{1, 1, 1}));
    EXPECT_EQ(a.triangle_texture, (std::vector<uint32_t>{UINT32_MAX, UINT32_MAX, UINT32_MAX, 0}));
}

TEST_F(ObjMaterials, ADeviceIsNoTexture) {
    save(folder_.file("m.mtl"), "newmtl m\nmap_Kd /dev/zero\n");
    EXPECT_EQ(textures("mtllib m.mtl\nusemtl m\n", 1), 0U);
    EXPECT_EQ(textures("mtllib /dev/zero\nusemtl m\n", 1), 0U);
}

// ---- OFF ------------------------------------------------------------------------------------------------------------

TEST(OffDialects, LinesMeanNothing) {
    const TriangleMesh expected = read(kOff, "off");
    for (const std::string& variant :
         {replaced(kOff, "\n", " "), replaced(kOff, " ", "\n"), replaced(kOff, "OFF\n", "OFF "),
          replaced(kOff, "3 0 2 1", "3 0\n2\n1"), replaced(kOff, "4 4 6", "# counts\n4 # four\n4"), kOff.substr(4),
          replaced(kOff, "OFF", "off"), replaced(kOff, "3 0 2 1", "3 0 2 1 7")}) {
        const TriangleMesh mesh = read(variant, "off");
        EXPECT_EQ(mesh.positions, expected.positions) << variant;
        EXPECT_EQ(mesh.triangles, expected.triangles) << variant;
    }
}

TEST(OffDialects, ColorsOfVerticesAndFacesAreRead) {
    const std::string faces = "3 0 1 2\n";
    for (const std::string color : {"255 0 51", "255 0 51 255", "1.0 0 0.2", "1 0 0.2 1"}) {
        for (const std::string keyword : {"COFF", "OFF"}) {
            const std::string text =
                keyword + "\n3 1 0\n0 0 0 " + color + "\n1 0 0 " + color + "\n0 1 0 " + color + "\n";
            const TriangleMesh mesh = read(text + faces, "off");
            ASSERT_EQ(mesh.appearance.corner_colors.size(), 1U) << text;
            EXPECT_EQ(mesh.appearance.corner_colors[0][2], (Color{1, 0, 0.2f})) << text;
        }
        const TriangleMesh mesh = read("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 " + color + "\n" + faces, "off");
        ASSERT_EQ(mesh.appearance.corner_colors.size(), 2U);
        EXPECT_EQ(mesh.appearance.corner_colors[0][0], (Color{1, 0, 0.2f})) << color;
        EXPECT_EQ(mesh.appearance.corner_colors[1][0], (Color{1, 1, 1})) << color;
    }
    const std::string normals = "0 0 0 0 0 -1\n1 0 0 0 0 -1\n0 1 0 0 0 -1\n";
    EXPECT_TRUE(read("NOFF\n3 1 0\n" + normals + faces, "off").appearance.empty());
    EXPECT_TRUE(read("OFF\n3 1 0\n" + normals + faces, "off").appearance.empty());
}

TEST(OffDialects, OtherDimensionsAreNamed) {
    for (const std::string keyword : {"4OFF", "nOFF", "C4nOFF", "STCN4OFF"}) {
        EXPECT_NE(message(keyword + "\n3 1 0\n", "").find("it is " + keyword), std::string::npos) << keyword;
    }
}

TEST(OffDialects, BinaryIsReadAndItsTruncationsAreRefused) {
    for (const std::string keyword : {"OFF", "COFF", "STCNOFF"}) {
        std::string text = keyword + " BINARY\n";
        for (const int32_t count : {3, 1, 3}) put_big_endian(text, count);
        for (int v = 0; v < 3; ++v) {
            for (const float x : {v == 1 ? 2.f : 0.f, v == 2 ? 1.f : 0.f, 0.f}) put_big_endian(text, x);
            if (keyword == "STCNOFF")
                for (const float x : {0.f, 0.f, 1.f}) put_big_endian(text, x);
            if (keyword != "OFF")
                for (const float x : {1.f, 0.5f, 0.25f, 1.f}) put_big_endian(text, x);
            if (keyword == "STCNOFF")
                for (const float x : {0.f, 1.f}) put_big_endian(text, x);
        }
        for (const int32_t i : {3, 0, 1, 2, 0}) put_big_endian(text, i);
        const TriangleMesh mesh = read(text, "off");
        ASSERT_EQ(mesh.positions.size(), 3U) << keyword;
        EXPECT_EQ(mesh.positions[1][0], 2);
        ASSERT_EQ(mesh.triangles.size(), 1U);
        if (keyword != "OFF") {
            EXPECT_EQ(mesh.appearance.corner_colors.at(0)[0], (Color{1, 0.5f, 0.25f}));
        }
        for (size_t size = 0; size < text.size(); ++size)
            EXPECT_NE(message(text.substr(0, size), "off"), "(was read)") << keyword << " cut at " << size;
    }
}

// ---- STL ------------------------------------------------------------------------------------------------------------

TEST(StlDialects, NamesAndLinesMayBeMissing) {
    for (const std::string& text :
         {"solid\n" + kFacet + kFacet + "endsolid", "solid\n" + kFacet + kFacet + "endsolids\n",
          "solid a\n" + kFacet + "endsolid a\nsolid b\n" + kFacet + "endsolid b\n",
          "solid outer vertex facet\n" + kFacet + kFacet + "endsolid outer vertex\n",
          "solid a " + replaced(kFacet + kFacet, "\n", " ") + "endsolid a",
          replaced(kStl, "endfacet\nendsolid", "endfacet endsolid"),
          "SOLID X\n" + replaced(replaced(kFacet + kFacet, "facet", "FACET"), "vertex", "Vertex") + "ENDSOLID X\n",
          replaced(kStl, "endloop", "end loop"), " \n" + kStl,
          replaced(kStl, "outer loop", "color 0 1 0\nouter loop")}) {
        const TriangleMesh mesh = read(text, "");
        EXPECT_EQ(mesh.positions.size(), 6U) << text;
        EXPECT_EQ(mesh.triangles.size(), 2U) << text;
    }
}

TEST(StlDialects, BinaryFilesMayBeginWithSolidAndEndLate) {
    const TriangleMesh expected = read(binary_stl(2, 2), "stl");
    ASSERT_EQ(expected.triangles.size(), 2U);
    for (const std::string& text : {binary_stl(2, 2) + "tail", binary_stl(2, 2, "solid facet") + std::string(49, '\0'),
                                    binary_stl(2, 2, std::string("solid") + '\0') + "tail",
                                    binary_stl(2, 2, std::string("\xEF\xBB\xBF") + "x")}) {
        EXPECT_EQ(read(text, "stl").positions, expected.positions);
    }
    EXPECT_TRUE(read_from("", binary_stl(2, 2) + "tail", "stl").warnings.empty());
    EXPECT_EQ(read_from("", binary_stl(2, 5), "stl").warnings.size(), 1U);
    for (const uint32_t unknown : {0U, UINT32_MAX}) {
        const Read result = read_from("", binary_stl(unknown, 2), "stl");
        EXPECT_EQ(mesh_of(result, "").positions, expected.positions);
        EXPECT_EQ(result.warnings.size(), 1U);
    }
}

// ---- PLY ------------------------------------------------------------------------------------------------------------

std::string colored_ply(const std::string& type, const std::string& color, const std::string& prefix = "") {
    std::string properties;
    for (const char* channel : {"red", "green", "blue"})
        properties += "property " + type + " " + prefix + channel + "\n";
    std::string text = replaced(replaced(kPlyHead, "vertex 4", "vertex 3"), "face 4", "face 1");
    text = replaced(text, "element face", properties + "element face");
    return text + "0 0 0 " + color + "\n1 0 0 " + color + "\n0 1 0 " + color + "\n3 0 1 2\n";
}

TEST(PlyDialects, TheFirstWordMayBeInCapitals) {
    const std::string text = "PLY" + kPly.substr(3);
    EXPECT_EQ(read(text, "").triangles, read(kPly, "ply").triangles);
}

TEST(PlyDialects, ColorsHaveEveryTypeAndRange) {
    const Color expected = {1, 0, 0.2f};
    for (const auto& [type, color] : std::vector<std::pair<std::string, std::string>>{{"uchar", "255 0 51"},
                                                                                      {"uchar", "2550 nan 51"},
                                                                                      {"char", "inf -999 51"},
                                                                                      {"char", "-1 0 51"},
                                                                                      {"float", "1 0 0.2"},
                                                                                      {"float", "255 0 51"},
                                                                                      {"double", "255.0 0 51"},
                                                                                      {"int", "255 0 51"},
                                                                                      {"ushort", "65535 0 13107"},
                                                                                      {"ushort", "255 0 51"}}) {
        for (const std::string prefix : {"", "diffuse_", "Diffuse_"}) {
            const TriangleMesh mesh = read(colored_ply(type, color, prefix), "ply");
            ASSERT_EQ(mesh.appearance.corner_colors.size(), 1U) << type;
            EXPECT_EQ(mesh.appearance.corner_colors[0][0], expected) << type << " " << color;
        }
    }
    // A byte of 1 is nearly black.
    EXPECT_LT(read(colored_ply("uchar", "1 1 1"), "ply").appearance.corner_colors.at(0)[0][0], 0.01f);
}

TEST(PlyDialects, FacesMayHaveTheColors) {
    const std::string head =
        replaced(kPlyHead, "vertex_indices\n",
                 "vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n");
    const TriangleMesh mesh =
        read(head + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1 255 0 51\n4 0 1 3 2 0 0 0\n3 1 2 3 0 0 0\n3 0 3 2 0 255 0\n",
             "ply");
    ASSERT_EQ(mesh.appearance.corner_colors.size(), 5U);
    EXPECT_EQ(mesh.appearance.corner_colors[0][2], (Color{1, 0, 0.2f}));
    EXPECT_EQ(mesh.appearance.corner_colors[2][0], (Color{0, 0, 0}));
    EXPECT_EQ(mesh.appearance.corner_colors[4][1], (Color{0, 1, 0}));
}

TEST(PlyDialects, ColoursOfVerticesWinOverThoseOfFacesWithAWarning) {
    const std::string colors = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" + colors +
        "element face 1\nproperty list uchar int vertex_indices\n" + colors + "end_header\n";
    const std::string vertices = "0 0 0 255 0 51\n1 0 0 255 0 51\n0 1 0 255 0 51\n";
    const Read tinted = read_from("", head + vertices + "3 0 1 2 0 255 0\n", "ply");
    EXPECT_EQ(mesh_of(tinted, "tinted").appearance.corner_colors.at(0)[0], (Color{1, 0, 0.2f}));
    EXPECT_EQ(tinted.warnings.size(), 1U);
    EXPECT_TRUE(read_from("", head + vertices + "3 0 1 2 255 255 255\n", "ply").warnings.empty());
}

TEST(PlyDialects, NumbersThatTheHeaderDoesNotNameAreDropped) {
    const TriangleMesh expected = read(kPly, "ply");
    for (const std::string& text :
         {replaced(kPly, "3 0 2 1", "3 0 2 1 255 0 0"), replaced(kPly, "\n1 0 0", "\n1 0 0 9 9"),
          replaced(kPly, "3 0 3 2", "3 0 3 2 7"), replaced(kPly, "0 0 0", "0 0 0 word")}) {
        const Read result = read_from("", text, "ply");
        const TriangleMesh mesh = mesh_of(result, text);
        EXPECT_EQ(mesh.positions, expected.positions) << text;
        EXPECT_EQ(mesh.triangles, expected.triangles) << text;
        EXPECT_EQ(result.warnings.size(), 1U) << text;
    }
    EXPECT_EQ(read(replaced(kPly, "\n1 0 0", " # first\n# all\n1 0 0"), "ply").positions, expected.positions);
    // Records that share or wrap lines.
    for (const std::string& text : {kPlyHead + replaced(kPly.substr(kPlyHead.size()), "\n", " "),
                                    kPlyHead + replaced(kPly.substr(kPlyHead.size()), " ", "\n")}) {
        const Read result = read_from("", text, "ply");
        EXPECT_EQ(mesh_of(result, text).triangles, expected.triangles);
        EXPECT_TRUE(result.warnings.empty());
    }
}

// ---- what is not a mesh of ours -------------------------------------------------------------------------------------

TEST(ForeignFormats, AreNamed) {
    using namespace std::string_view_literals;
    const std::string zip = std::string("PK\x03\x04") + std::string(26, '\x01');
    for (const auto& [content, name] : std::vector<std::pair<std::string, std::string>>{
             {zip + "[Content_Types].xml 3D/3dmodel.model", "3MF"},
             {zip + "scene.usdc", "USDZ"},
             {zip + "mesh.obj", "ZIP archive; unpack"},
             {std::string("\x1F\x8B\x08\0"sv), "gzip; unpack"},
             {"Kaydara FBX Binary  ", "FBX"},
             {"; FBX 7.4.0 project file\n", "FBX"},
             {"<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"x\">", "Collada"},
             {"ISO-10303-21;\nHEADER;", "STEP"},
             {"Ogawa\xFF", "Alembic"},
             {"BLENDER-v300", "Blender"},
             {"#VRML V2.0 utf8\n", "VRML"},
             {"<!DOCTYPE html><html>", "web page"},
             {"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", "git lfs pull"}}) {
        for (const char* extension : {"", "obj", "stl", "ply", "off", "glb"}) {
            EXPECT_NE(message(content, extension).find(name), std::string::npos)
                << name << " as " << extension << ": " << message(content, extension);
        }
    }
}

// ---- memory ---------------------------------------------------------------------------------------------------------

TEST(MaxMemory, IsCheckedBeforeItIsTakenAndNamesTheOption) {
    for (const auto& [text, extension] :
         {std::pair{kPly, "ply"}, {kObj, "obj"}, {kOff, "off"}, {kStl, "stl"}, {binary_stl(4, 4), "stl"}}) {
        const Bytes bytes = to_bytes(text);
        for (const uint64_t limit : {uint64_t{100}, uint64_t{100000}}) {
            ReadContext context;
            context.memory = MemoryBudget(limit);
            const Result<TriangleMesh> mesh = read_mesh(bytes, detect_format(bytes, extension), context);
            EXPECT_EQ(mesh.ok(), limit > 100) << extension;
            if (!mesh.ok()) {
                EXPECT_NE(mesh.error().message.find("--max-memory"), std::string::npos);
            }
        }
    }
}

TEST(MaxMemory, ProductsDoNotOverflow) {
    MemoryBudget memory(1000);
    EXPECT_FALSE(memory.take(UINT64_MAX, UINT64_MAX, "its claims").ok());
    EXPECT_TRUE(memory.take(10, 100, "its tens").ok());
    EXPECT_FALSE(memory.try_take(1));
    EXPECT_NE(memory.take(3, 1U << 30, "its pixels").error().message.find("its pixels take 3.0 GB"), std::string::npos);
}

}  // namespace
}  // namespace gim
