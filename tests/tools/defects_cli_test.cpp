// What `gim compare`, `gim encode` and `gim render` say and show of visible defects.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace gim {
namespace {

using nlohmann::json;
using test::gim;
using test::load_text;
using test::obj_text;
using test::Outcome;
using test::save;
using test::save_corpus_mesh;
using test::TemporaryFolder;

// A flat square of 4 x 4 cells. One inner vertex moves by `shift` cells to the right: two triangles fold over if that is
// more than one cell.
TriangleMesh square(double shift) {
    TriangleMesh mesh;
    for (uint32_t i = 0; i < 25; ++i)
        mesh.positions.push_back({i % 5 + (i == 11 ? shift : 0.0), static_cast<double>(i / 5), 0});
    for (uint32_t i = 0; i < 20; ++i) {
        if (i % 5 == 4) continue;
        mesh.triangles.push_back({i, i + 1, i + 6});
        mesh.triangles.push_back({i, i + 6, i + 5});
    }
    return mesh;
}

class DefectsCli : public ::testing::Test {
  protected:
    void SetUp() override {
        save(flat, obj_text(square(0)));
        save(folded, obj_text(square(1.8)));
    }
    TemporaryFolder folder;
    const std::string flat = folder.file("flat.obj"), folded = folder.file("folded.obj");
};

TEST_F(DefectsCli, CompareTellsPeople) {
    const Outcome outcome = gim({"compare", flat, folded, "--samples", "20000"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    for (const char* line :
         {"folded over                2 triangles, ", "largest fold               2 triangles near (2.1, 2, 0)",
          "edges folded back          4 (0 in the reference)", "normals off by > 20, > 45  ",
          "normals, 95 %, 99 %        ", "distance / RMS, 99.9 %     "}) {
        EXPECT_NE(outcome.out.find(line), std::string::npos) << line << "\n" << outcome.out;
    }
    const Outcome equal = gim({"compare", flat, flat, "--samples", "2000"});
    EXPECT_NE(equal.out.find("folded over                0 triangles, 0.0000% of the area"), std::string::npos);
    EXPECT_EQ(equal.out.find("largest fold"), std::string::npos);
}

TEST_F(DefectsCli, CompareTellsPrograms) {
    const Outcome outcome = gim({"compare", flat, folded, "--samples", "20000", "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json defects = json::parse(outcome.out)["comparison"]["defects"];
    EXPECT_EQ(defects["folded_faces"], 2);
    EXPECT_NEAR(defects["folded_area"].get<double>(), 0.8 / 17.6, 1e-3);
    EXPECT_EQ(defects["folded_back_edges"], 4);
    EXPECT_EQ(defects["folded_back_edges_of_reference"], 0);
    EXPECT_EQ(defects["largest_fold"]["faces"], 2);
    EXPECT_NEAR(defects["largest_fold"]["area"].get<double>(), 0.8, 1e-9);
    EXPECT_NEAR(defects["largest_fold"]["center"][0].get<double>(), 2.1, 1e-9);
    for (const char* figure :
         {"off_by_20", "off_by_45", "normals_p95", "normals_p99", "p999_over_rms", "max_over_rms"}) {
        EXPECT_TRUE(defects[figure].is_number()) << figure;
    }
}

TEST_F(DefectsCli, EncodeTellsThoseOfTheDecodedSurface) {
    const std::string mesh = folder.file("blob.obj"), file = folder.file("blob.gim"),
                      report = folder.file("report.json");
    save_corpus_mesh("limbs-rough", mesh);
    const Outcome run = gim({"encode", mesh, file, "--size", "33", "--quality", "30", "--json", report});
    ASSERT_EQ(run.status, 0) << run.err;
    const json told = json::parse(load_text(report));
    EXPECT_GT(told["folds"], 0);
    EXPECT_EQ(told["folds"], told["error"]["defects"]["folded_faces"]);
    EXPECT_NE(run.out.find("largest fold"), std::string::npos);
    EXPECT_NE(run.out.find("folded over"), std::string::npos);
    for (size_t level = 0; level < told["levels"].size(); ++level) {
        const Outcome compared = gim({"compare", mesh, file, "--level", std::to_string(level), "--json"});
        const json expected = json::parse(compared.out)["comparison"]["defects"],
                   found = told["levels"][level]["defects"];
        EXPECT_EQ(found["folded_faces"], expected["folded_faces"]) << level;
        EXPECT_EQ(found["folded_back_edges"], expected["folded_back_edges"]) << level;
        EXPECT_NEAR(found["off_by_20"].get<double>(), expected["off_by_20"].get<double>(), 0.01) << level;
    }
}

TEST_F(DefectsCli, RenderPaintsThemAloneAndBesideTheImage) {
    const std::string alone = folder.file("alone.png"), three = folder.file("three.png"),
                      file = folder.file("flat.gim");
    EXPECT_EQ(gim({"render", folded, alone, "--defects", flat, "--size", "64"}).status, 0);
    EXPECT_EQ(load_text(alone).substr(1, 3), "PNG");
    ASSERT_EQ(gim({"encode", flat, file, "--size", "17", "--node-side", "9", "--quiet"}).status, 0);
    EXPECT_EQ(gim({"render", flat, three, "--gim", file, "--defects", flat, "--size", "64"}).status, 0);
    EXPECT_EQ(static_cast<uint8_t>(load_text(three)[19]), 3 * 64);  // width, big-endian at offset 16
}

TEST_F(DefectsCli, RenderNamesAMissingReference) {
    const Outcome run = gim({"render", folded, folder.file("a.png"), "--defects", "no-such.ply"});
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.err.find("no-such.ply"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace gim
