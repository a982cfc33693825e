// Hard edges on their way from files to files: readers, tiles, writers, and back.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "encoder/surface/authored_edges.h"
#include "encoder/surface/clean.h"
#include "tests/shaded_part.h"
#include "tests/tools/gltf_builder.h"
#include "tests/tools/program.h"
#include "tests/tools/test_files.h"
#include "tools/input.h"

namespace gim {
namespace {

using test::gim;
using test::GltfBuilder;
using test::obj_text;
using test::Outcome;
using test::save;
using test::shade_flat;
using test::ShadedPart;
using test::TemporaryFolder;

template <class... Numbers>
std::string line(const char* format, Numbers... numbers) {
    char text[160];
    std::snprintf(text, sizeof(text), format, numbers...);
    return text;
}

std::string obj_with_normals(const TriangleMesh& mesh) {
    std::string text;
    for (const auto& p : mesh.positions) text += line("v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
    for (const auto& n : mesh.shading.normals)
        text += line("vn %.4f %.4f %.4f\n", double{n[0]}, double{n[1]}, double{n[2]});
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        const auto& t = mesh.triangles[f];
        const auto& n = mesh.shading.corners[f];
        text += line("f %u//%u %u//%u %u//%u\n", t[0] + 1, n[0] + 1, t[1] + 1, n[1] + 1, t[2] + 1, n[2] + 1);
    }
    return text;
}

// group(normal of the face): its smoothing group.
std::string obj_with_groups(const TriangleMesh& mesh,
                            const std::function<std::string(const std::array<float, 3>&)>& group) {
    std::string text;
    for (const auto& p : mesh.positions) text += line("v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        const auto& t = mesh.triangles[f];
        text += "s " + group(mesh.shading.normals[mesh.shading.corners[f][1]]) + "\n";
        text += line("f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    return text;
}

std::string group_of_part(const std::array<float, 3>& n) {
    if (std::abs(n[2]) > 0.5F) return "off";
    if (n[1] < -0.9F) return n[0] < 0 ? "2" : "3";
    return "1";
}

std::string ply_with_normals(const TriangleMesh& split) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(split.positions.size()) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) text += "property float " + std::string(name) + "\n";
    text += "element face " + std::to_string(split.triangles.size()) +
            "\nproperty list uchar int vertex_indices\nend_header\n";
    for (size_t v = 0; v < split.positions.size(); ++v) {
        const auto& p = split.positions[v];
        const auto& n = split.shading.normals[v];
        text += line("%.9g %.9g %.9g %.6f %.6f %.6f\n", p[0], p[1], p[2], double{n[0]}, double{n[1]}, double{n[2]});
    }
    for (const auto& t : split.triangles) text += line("3 %u %u %u\n", t[0], t[1], t[2]);
    return text;
}

GltfBuilder gltf_of(const TriangleMesh& split, bool with_normals = true) {
    GltfBuilder file;
    std::vector<float> positions, normals;
    std::vector<uint32_t> indices;
    for (const auto& p : split.positions)
        for (const double x : p) positions.push_back(static_cast<float>(x));
    for (const auto& n : split.shading.normals) normals.insert(normals.end(), n.begin(), n.end());
    for (const auto& t : split.triangles) indices.insert(indices.end(), t.begin(), t.end());
    file.attribute("POSITION", file.accessor<float>("VEC3", positions));
    if (with_normals) file.attribute("NORMAL", file.accessor<float>("VEC3", normals));
    file.primitive()["indices"] = file.accessor<uint32_t>("SCALAR", indices);
    return file;
}

struct Found {
    Mesh mesh;
    AuthoredEdges edges;
    std::vector<std::string> warnings;
};

Found found_in(const std::string& path, bool shading = true) {
    ReadOptions how;
    how.shading = shading;
    auto input = read_input(path, how);
    EXPECT_TRUE(input.ok()) << (input.ok() ? "" : input.error().message);
    if (!input.ok()) return {};
    auto cleaned = clean(input.value().mesh, {.require_connected = false});
    EXPECT_TRUE(cleaned.ok()) << (cleaned.ok() ? "" : cleaned.error().message);
    if (!cleaned.ok()) return {};
    const AuthoredEdges edges = read_authored_edges(cleaned.value().mesh, cleaned.value().breaks);
    return {std::move(cleaned.value().mesh), edges, input.value().warnings};
}

Found found_in_text(const std::string& text, const std::string& name) {
    const TemporaryFolder folder;
    save(folder.file(name), text);
    return found_in(folder.file(name));
}

// ---- readers --------------------------------------------------------------------------------------------------------

TEST(HardEdges, AreReadFromEveryFormatThatHasNormals) {
    const ShadedPart part;
    const TriangleMesh split = part.split();
    const std::vector<std::pair<std::string, std::string>> files = {
        {obj_with_normals(part.mesh), "shared.obj"},
        {obj_with_normals(split), "split.obj"},
        {obj_with_groups(part.mesh, group_of_part), "groups.obj"},
        {ply_with_normals(split), "split.ply"},
        {gltf_of(split).text(), "split.gltf"}};
    for (const auto& [text, name] : files) {
        const Found found = found_in_text(text, name);
        EXPECT_EQ(found.edges.named, ShadedPart::kHardEdges) << name;
        EXPECT_EQ(found.edges.kept, ShadedPart::kHardEdges) << name;
        EXPECT_TRUE(found.warnings.empty()) << name;
    }
}

TEST(HardEdges, AreReadOnlyIfTheyAreWanted) {
    const TemporaryFolder folder;
    save(folder.file("part.obj"), obj_with_normals(ShadedPart().mesh));
    EXPECT_TRUE(found_in(folder.file("part.obj"), false).edges.words.empty());
    auto input = read_input(folder.file("part.obj"), {});
    ASSERT_TRUE(input.ok());
    EXPECT_TRUE(input.value().mesh.shading.empty());
}

TEST(HardEdges, FilesThatSmoothAllOrNothingNameNone) {
    TriangleMesh part = ShadedPart().mesh;
    const auto all = [](const char* group) { return [group](const auto&) { return std::string(group); }; };
    const std::string smooth = obj_with_groups(part, all("1")), off = obj_with_groups(part, all("off"));
    const std::string without = gltf_of(ShadedPart().split(), false).text();
    shade_flat(part);
    const std::vector<std::pair<std::string, std::string>> files = {{smooth, "smooth.obj"},
                                                                    {off, "off.obj"},
                                                                    {obj_text(part), "bare.obj"},
                                                                    {obj_with_normals(part), "flat.obj"},
                                                                    {without, "bare.gltf"}};
    for (const auto& [text, name] : files) {
        const Found found = found_in_text(text, name);
        EXPECT_EQ(found.edges.named, 0u) << name;
        EXPECT_TRUE(found.edges.words.empty()) << name;
    }
}

TEST(HardEdges, SeamsOfTexturesAreSmooth) {
    // Every triangle has vertices of its own, with the normals of the part.
    const ShadedPart part;
    TriangleMesh soup;
    for (size_t f = 0; f < part.mesh.triangles.size(); ++f) {
        const auto first = static_cast<uint32_t>(soup.positions.size());
        for (size_t i = 0; i < 3; ++i) {
            soup.positions.push_back(part.mesh.positions[part.mesh.triangles[f][i]]);
            soup.shading.normals.push_back(part.mesh.shading.normals[part.mesh.shading.corners[f][i]]);
        }
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    soup.shading.corners = soup.triangles;
    for (const auto& [text, name] :
         {std::pair{gltf_of(soup).text(), "soup.gltf"}, {ply_with_normals(soup), "soup.ply"}}) {
        const Found found = found_in_text(text, name);
        EXPECT_EQ(found.edges.named, ShadedPart::kHardEdges) << name;
        EXPECT_EQ(found.edges.kept, ShadedPart::kHardEdges) << name;
    }
}

TEST(HardEdges, FollowTheTransformsOfTheScene) {
    GltfBuilder file = gltf_of(ShadedPart().split());
    file.node()["scale"] = {-3, 1, 0.5};
    file.node()["rotation"] = {0.5, 0.5, 0.5, 0.5};
    const Found found = found_in_text(file.text(), "turned.gltf");
    EXPECT_EQ(found.edges.kept, ShadedPart::kHardEdges);

    const TemporaryFolder folder;
    save(folder.file("turned.gltf"), file.text());
    ReadOptions how;
    how.shading = true;
    const auto input = read_input(folder.file("turned.gltf"), how);
    ASSERT_TRUE(input.ok());
    const TriangleMesh& mesh = input.value().mesh;
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        const auto at = [&](size_t i) { return Eigen::Vector3d(mesh.positions[mesh.triangles[f][i]].data()); };
        const Eigen::Vector3d facet = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
        for (const uint32_t n : mesh.shading.corners[f]) {
            const Eigen::Vector3d normal = Eigen::Vector3f(mesh.shading.normals[n].data()).cast<double>();
            EXPECT_GT(facet.dot(normal), 0.8);
        }
    }
}

TEST(HardEdges, NormalsOfObjMayStandFurtherDownAndCountBackwards) {
    const TriangleMesh part = ShadedPart().mesh;
    std::string vertices, normals, ahead, back;
    for (const auto& p : part.positions) vertices += line("v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
    for (const auto& n : part.shading.normals)
        normals += line("vn %.4f %.4f %.4f\n", double{n[0]}, double{n[1]}, double{n[2]});
    const auto count = static_cast<int>(part.shading.normals.size());
    for (size_t f = 0; f < part.triangles.size(); ++f) {
        ahead += "f", back += "f";
        for (size_t i = 0; i < 3; ++i) {
            const auto v = static_cast<int>(part.triangles[f][i]), n = static_cast<int>(part.shading.corners[f][i]);
            ahead += line(" %d/7/%d", v + 1, n + 1);
            back += line(" %d//%d", v + 1, n - count);
        }
        ahead += "\n", back += "\n";
    }
    EXPECT_EQ(found_in_text(vertices + ahead + normals, "ahead.obj").edges.kept, ShadedPart::kHardEdges);
    EXPECT_EQ(found_in_text(vertices + normals + back, "back.obj").edges.kept, ShadedPart::kHardEdges);
}

TEST(HardEdges, NormalsThatDoNotExistAreToldAndLeftOut) {
    const std::string good = obj_with_normals(ShadedPart().mesh);
    for (const char* bad : {"999999", "0", "-999999", "x", "4294967295", "4294967296", "99999999999999999999"}) {
        std::string text = good;
        const size_t at = text.rfind("//");
        text = text.substr(0, at + 2) + bad + "\n";
        const Found found = found_in_text(text, "bad.obj");
        EXPECT_TRUE(found.edges.words.empty()) << bad;
        ASSERT_EQ(found.warnings.size(), 1u) << bad;
        EXPECT_NE(found.warnings[0].find("normals that do not exist"), std::string::npos) << found.warnings[0];
    }
    GltfBuilder file = gltf_of(ShadedPart().split());
    file.attribute("NORMAL", file.accessor<float>("VEC3", {0, 0, 1}));
    const Found found = found_in_text(file.text(), "bad.gltf");
    EXPECT_TRUE(found.edges.words.empty());
    ASSERT_EQ(found.warnings.size(), 1u);
    EXPECT_NE(found.warnings[0].find("NORMAL"), std::string::npos) << found.warnings[0];
}

// ---- there and back -------------------------------------------------------------------------------------------------

using Segment = std::array<Vec3, 2>;

std::vector<Segment> hard_segments(const Found& found) {
    std::vector<Segment> segments;
    for (uint32_t h = 0; h < found.edges.words.size(); ++h) {
        if (found.edges.words[h] == EdgeWord::kHard && from(found.mesh, h) < to(found.mesh, h))
            segments.push_back({found.mesh.positions[from(found.mesh, h)], found.mesh.positions[to(found.mesh, h)]});
    }
    return segments;
}

// Returns the length of the segments whose middles are farther from all others.
double missed_length(const std::vector<Segment>& of, const std::vector<Segment>& by, double tolerance) {
    double length = 0;
    for (const Segment& s : of) {
        const Vec3 middle = 0.5 * (s[0] + s[1]);
        const bool is_near = std::any_of(by.begin(), by.end(), [&](const Segment& b) {
            const Vec3 way = b[1] - b[0];
            const double t = std::clamp((middle - b[0]).dot(way) / way.squaredNorm(), 0.0, 1.0);
            return (b[0] + t * way - middle).norm() < tolerance;
        });
        length += is_near ? 0 : (s[1] - s[0]).norm();
    }
    return length;
}

nlohmann::json encode_tiles(const std::string& from, const std::string& to) {
    const Outcome run = gim({"encode", from, to, "--layout", "tiles", "--quality", "60", "--samples", "3000", "--quiet",
                             "--json", to + ".json"});
    EXPECT_EQ(run.status, 0) << run.err;
    return run.status == 0 ? nlohmann::json::parse(test::load_text(to + ".json")) : nlohmann::json();
}

TEST(HardEdges, OutliveTilesAndComeBack) {
    const ShadedPart part;
    const TemporaryFolder folder;
    save(folder.file("part.obj"), obj_with_normals(part.mesh));
    save(folder.file("part.ply"), ply_with_normals(part.split()));
    save(folder.file("part.gltf"), gltf_of(part.split()).text());
    const std::vector<Segment> meant = hard_segments(found_in(folder.file("part.obj")));
    double all = 0;
    for (const Segment& s : meant) all += (s[1] - s[0]).norm();

    for (const char* source : {"part.obj", "part.ply", "part.gltf"}) {
        const auto report = encode_tiles(folder.file(source), folder.file("part.gim"));
        ASSERT_EQ(report["layout"], "tiles") << source;
        EXPECT_EQ(report["hard_edges"], ShadedPart::kHardEdges) << source;
        EXPECT_EQ(report["hard_edges_kept"], ShadedPart::kHardEdges) << source;
        for (const char* decoded : {"back.obj", "back.glb"}) {
            const Outcome run = gim({"decode", folder.file("part.gim"), folder.file(decoded)});
            ASSERT_EQ(run.status, 0) << run.err;
            const std::vector<Segment> back = hard_segments(found_in(folder.file(decoded)));
            EXPECT_LT(missed_length(meant, back, 0.02), 0.02 * all) << source << ", " << decoded;
            EXPECT_LT(missed_length(back, meant, 0.02), 0.02 * all) << source << ", " << decoded;
        }
        const auto again = encode_tiles(folder.file("back.obj"), folder.file("again.gim"));
        EXPECT_GT(again["hard_edges_kept"], 0) << source;
        ASSERT_EQ(gim({"decode", folder.file("again.gim"), folder.file("again.obj")}).status, 0);
        const std::vector<Segment> twice = hard_segments(found_in(folder.file("again.obj")));
        EXPECT_LT(missed_length(meant, twice, 0.02), 0.04 * all) << source;
        EXPECT_LT(missed_length(twice, meant, 0.02), 0.04 * all) << source;
    }
}

TEST(HardEdges, WithoutAuthorsTilesKeepTheirBytes) {
    const ShadedPart part;
    TriangleMesh flat = part.mesh;
    shade_flat(flat);
    const TemporaryFolder folder;
    save(folder.file("bare.obj"), obj_text(part.mesh));
    save(folder.file("flat.obj"), obj_with_normals(flat));
    const auto bare = encode_tiles(folder.file("bare.obj"), folder.file("bare.gim"));
    const auto report = encode_tiles(folder.file("flat.obj"), folder.file("flat.gim"));
    EXPECT_EQ(report["hard_edges"], 0);
    EXPECT_EQ(report["hard_edges_kept"], 0);
    EXPECT_EQ(test::load_text(folder.file("bare.gim")), test::load_text(folder.file("flat.gim")));
}

TEST(HardEdges, SquaresKeepTheirBytes) {
    const ShadedPart part;
    const TemporaryFolder folder;
    save(folder.file("bare.obj"), obj_text(part.mesh));
    save(folder.file("part.obj"), obj_with_normals(part.mesh));
    for (const char* name : {"bare", "part"}) {
        const Outcome run =
            gim({"encode", folder.file(std::string(name) + ".obj"), folder.file(std::string(name) + ".gim"), "--layout",
                 "gim", "--size", "33", "--quiet"});
        ASSERT_EQ(run.status, 0) << run.err;
    }
    EXPECT_EQ(test::load_text(folder.file("bare.gim")), test::load_text(folder.file("part.gim")));
}

TEST(HardEdges, AreInTheSummary) {
    const TemporaryFolder folder;
    save(folder.file("part.obj"), obj_with_normals(ShadedPart().mesh));
    const Outcome run =
        gim({"encode", folder.file("part.obj"), folder.file("part.gim"), "--layout", "tiles", "--samples", "3000"});
    ASSERT_EQ(run.status, 0) << run.err;
    const std::string count = std::to_string(ShadedPart::kHardEdges);
    EXPECT_NE(run.out.find(count + " in the input, " + count + " kept sharp"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace gim
