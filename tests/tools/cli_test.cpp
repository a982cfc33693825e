// The gim program as its users meet it: exit status, stdout and stderr, files left on the disk.
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace gim {
namespace {

using nlohmann::json;
using test::gim;
using test::load_text;
using test::Outcome;
using test::save;
using test::save_corpus_mesh;
using test::TemporaryFolder;

// One small encoded torus for all tests that only read it.
class Cli : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        shared_folder = new TemporaryFolder;
        save_corpus_mesh("torus-576", mesh_path());
        encoded = gim({"encode", mesh_path(), gim_path(), "--size", "65", "--node-side", "9", "--lossless", "--bits",
                       "16", "--json", shared_folder->file("report.json")});
    }
    static void TearDownTestSuite() {
        delete shared_folder;
        shared_folder = nullptr;
    }
    static std::string mesh_path() { return shared_folder->file("torus.obj"); }
    static std::string gim_path() { return shared_folder->file("torus.gim"); }

    static inline TemporaryFolder* shared_folder = nullptr;
    static inline Outcome encoded;
    TemporaryFolder folder;
};

TEST_F(Cli, EncodePrintsFiguresAndWritesTheReport) {
    ASSERT_EQ(encoded.status, 0) << encoded.err;
    EXPECT_NE(encoded.out.find("PSNR"), std::string::npos);
    EXPECT_EQ(encoded.err, "");  // no terminal, no progress
    const json report = json::parse(load_text(shared_folder->file("report.json")));
    EXPECT_EQ(report["input_vertices"], 288);
    EXPECT_EQ(report["file_bytes"], std::filesystem::file_size(gim_path()));
    EXPECT_EQ(report["topology"]["genus"], 1);
    EXPECT_EQ(report["flipped_triangles"], 0);
    EXPECT_FALSE(report["times"].empty());
    EXPECT_GT(report["error"]["psnr"], 40);
}

TEST_F(Cli, TheLargestErrorCanBeAskedForInPercentAndInUnits) {
    const json before = json::parse(load_text(shared_folder->file("report.json")));
    const double diagonal = before["error"]["diagonal"];
    for (const std::string& length : {std::string("3%"), std::string("3 %"), std::to_string(0.03 * diagonal)}) {
        const Outcome run = gim({"encode", mesh_path(), folder.file("a.gim"), "--size", "33", "--fit", "none",
                                 "--max-error", length, "--json", folder.file("a.json")});
        ASSERT_EQ(run.status, 0) << length << run.err;
        EXPECT_NE(run.out.find("largest error"), std::string::npos);
        const json report = json::parse(load_text(folder.file("a.json")));
        EXPECT_LE(report["error"]["hausdorff"].get<double>(), 0.03 * diagonal + 1e-6) << length;
        EXPECT_GE(report["error"]["hausdorff"].get<double>(), 0.02 * diagonal) << length;
    }
    const Outcome run =
        gim({"encode", mesh_path(), folder.file("b.gim"), "--size", "9", "--node-side", "9", "--max-error", "0.001%"});
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.err.find("% of the diagonal) is out of reach"), std::string::npos) << run.err;
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.gim", "a.json"}));
}

TEST_F(Cli, QuietSaysNothingAndJsonCanGoToStdout) {
    const Outcome quiet =
        gim({"encode", mesh_path(), folder.file("a.gim"), "--size", "33", "--node-side", "9", "--quiet"});
    EXPECT_EQ(quiet.status, 0);
    EXPECT_EQ(quiet.out + quiet.err, "");
    const Outcome piped =
        gim({"encode", mesh_path(), folder.file("b.gim"), "--size", "33", "--node-side", "9", "--json", "-"});
    EXPECT_EQ(piped.status, 0);
    EXPECT_TRUE(json::accept(piped.out)) << piped.out;
    EXPECT_EQ(load_text(folder.file("a.gim")), load_text(folder.file("b.gim"))) << "same input, same bytes";
}

TEST_F(Cli, EveryOutputFormatIsTheSameWatertightSurfaceAtEveryLevel) {
    const Outcome info = gim({"info", gim_path(), "--json"});
    ASSERT_EQ(info.status, 0) << info.err;
    const json description = json::parse(info.out);
    EXPECT_EQ(description["layout"], "gim");
    EXPECT_EQ(description["coding"], "lossless");
    EXPECT_EQ(description["bytes"], std::filesystem::file_size(gim_path()));
    EXPECT_TRUE(description["intact"]);
    const json levels = description["images"][0]["levels"];
    ASSERT_GE(levels.size(), 3U);

    for (const json& level : levels) {
        const std::string number = std::to_string(level["level"].get<int>());
        for (const std::string extension : {"ply", "obj", "off", "stl", "glb"}) {
            const std::string path = folder.file("torus" + number + "." + extension);
            const Outcome decode = gim({"decode", gim_path(), path, "--level", number});
            ASSERT_EQ(decode.status, 0) << decode.err;
            const Outcome compare = gim({"compare", gim_path(), path, "--json", "--samples", "2000"});
            ASSERT_EQ(compare.status, 0) << compare.err;
            const json result = json::parse(compare.out);
            EXPECT_TRUE(result["test"]["topology"]["watertight"]) << extension << " level " << number;
            EXPECT_EQ(result["test"]["topology"]["genus"], 1) << extension << " level " << number;
            EXPECT_EQ(result["test"]["topology"]["triangles"], level["triangles"]);
            EXPECT_EQ(result["test"]["topology"]["vertices"], level["vertices"]) << extension;
            if (level["level"] == 0) {
                EXPECT_LT(result["comparison"]["hausdorff"].get<double>(),
                          1e-6 * result["comparison"]["diagonal"].get<double>());
                EXPECT_LT(result["comparison"]["normal_error"]["mean"].get<double>(), 0.01) << extension;
            }
        }
    }
    EXPECT_EQ(gim({"decode", gim_path(), folder.file("torus.exr")}).status, 0);
    const Outcome beyond = gim({"decode", gim_path(), folder.file("x.ply"), "--level", "12"});
    EXPECT_EQ(beyond.status, 1);
    EXPECT_NE(beyond.err.find("coarsest level"), std::string::npos) << beyond.err;
    EXPECT_FALSE(std::filesystem::exists(folder.file("x.ply")));
}

TEST_F(Cli, InfoIsForPeopleToo) {
    const Outcome info = gim({"info", gim_path()});
    EXPECT_EQ(info.status, 0);
    for (const char* word : {"layout gim", "lossless", "bits per sample", "cut paths", "level", "chunks", "intact"}) {
        EXPECT_NE(info.out.find(word), std::string::npos) << word;
    }
}

TEST_F(Cli, InfoTellsWhatClustersAreWorth) {
    EXPECT_EQ(gim({"info", gim_path()}).out.find("clusters"), std::string::npos);
    const Outcome text = gim({"info", gim_path(), "--clusters"});
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_NE(text.out.find("clusters of 8 x 8 cells"), std::string::npos);
    const json image = json::parse(gim({"info", gim_path(), "--clusters", "--json"}).out)["images"][0];
    ASSERT_GE(image["clusters"].size(), 2U);
    EXPECT_EQ(image["clusters"][0]["triangles"], image["levels"][0]["triangles"]);
    EXPECT_EQ(image["clusters"][0]["error"], 0);
    EXPECT_GT(image["clusters"][1]["error"], 0);
    EXPECT_LT(image["clusters"][0]["acmr"], 0.8);
    EXPECT_GT(image["clusters"][0]["culled"], 0);
}

TEST_F(Cli, CompareReadsMeshesAndGimFilesOnBothSides) {
    for (const auto& [reference, test] : {std::pair{mesh_path(), gim_path()}, std::pair{gim_path(), mesh_path()}}) {
        const Outcome compare = gim({"compare", reference, test, "--samples", "5000"});
        EXPECT_EQ(compare.status, 0) << compare.err;
        for (const char* word :
             {"RMS reference to test", "RMS test to reference", "Hausdorff", "PSNR", "normals", "watertight"}) {
            EXPECT_NE(compare.out.find(word), std::string::npos) << word;
        }
    }
}

TEST_F(Cli, EvenSamplesAreNotWhereTheUsualOnesAre) {
    save_corpus_mesh("terrain-3200", folder.file("terrain.obj"));
    const auto file = [&](const std::vector<std::string>& options) {
        std::vector<std::string> arguments = {"encode",
                                              folder.file("terrain.obj"),
                                              folder.file("terrain.gim"),
                                              "--size",
                                              "33",
                                              "--lossless",
                                              "--fit",
                                              "none",
                                              "--quiet"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        EXPECT_EQ(gim(arguments).status, 0);
        return load_text(folder.file("terrain.gim"));
    };
    EXPECT_NE(file({"--even"}), file({}));
}

// A square against its left half: half of the square is up to 1 away from it; all of the half lies on the square.
TEST_F(Cli, CompareTellsReferenceAndTestApart) {
    save(folder.file("whole.obj"), "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n");
    save(folder.file("half.obj"), "v -1 -1 0\nv 0 -1 0\nv 0 1 0\nv -1 1 0\nf 1 2 3 4\n");
    const Outcome outcome =
        gim({"compare", folder.file("whole.obj"), folder.file("half.obj"), "--samples", "5000", "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const json comparison = json::parse(outcome.out)["comparison"];
    EXPECT_NEAR(comparison["diagonal"].get<double>(), std::sqrt(8.0), 1e-6);
    EXPECT_NEAR(comparison["max_to_test"].get<double>(), 1, 1e-6);
    EXPECT_NEAR(comparison["max_to_reference"].get<double>(), 0, 1e-6);
}

TEST_F(Cli, MaxMemoryBoundsEveryCommandThatReadsAMesh) {
    save(folder.file("mesh.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\ncurv 0 1\nf 1 2 3\n");
    const std::string mesh = folder.file("mesh.obj");
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"encode", mesh, folder.file("new.gim"), "--size", "9"},
          std::vector<std::string>{"compare", mesh, mesh, "--samples", "1000"},
          std::vector<std::string>{"render", mesh, folder.file("new.png"), "--size", "16"}}) {
        std::vector<std::string> limited = command;
        limited.insert(limited.end(), {"--max-memory", "60"});
        const Outcome refused = gim(limited);
        EXPECT_EQ(refused.status, 1) << command[0];
        EXPECT_NE(refused.err.find("--max-memory"), std::string::npos) << refused.err;
        limited.back() = "1M";
        EXPECT_EQ(gim(limited).err.find("--max-memory"), std::string::npos) << command[0];
        // Warnings of readers reach the user of each command.
        EXPECT_NE(gim(limited).err.find("warning: its free-form"), std::string::npos) << command[0];
        limited.back() = "many";
        EXPECT_EQ(gim(limited).status, 2) << command[0];
    }
}

TEST_F(Cli, CompareTakesTheLevelOfTheTestSurface) {
    double finer = std::numeric_limits<double>::infinity();
    for (const char* level : {"0", "1", "2"}) {
        const Outcome outcome =
            gim({"compare", mesh_path(), gim_path(), "--samples", "5000", "--json", "--level", level});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        const double psnr = json::parse(outcome.out)["comparison"]["psnr"].get<double>();
        EXPECT_LT(psnr, finer) << level;
        finer = psnr;
    }
}

TEST_F(Cli, RenderDrawsOneOrThreePanels) {
    EXPECT_EQ(gim({"render", mesh_path(), folder.file("one.png"), "--size", "64", "--wire", "--flat"}).status, 0);
    EXPECT_EQ(gim({"render", mesh_path(), folder.file("three.png"), "--gim", gim_path(), "--size", "64"}).status, 0);
    const std::string three = load_text(folder.file("three.png"));
    ASSERT_GT(three.size(), 24U);
    EXPECT_EQ(three.substr(1, 3), "PNG");
    EXPECT_EQ(static_cast<uint8_t>(three[19]), 3 * 64);  // width, big-endian at offset 16
}

TEST_F(Cli, DamagedFilesAreReportedWithStatusOne) {
    const std::string whole = load_text(gim_path());
    std::string flipped = whole;
    flipped[whole.size() - 10] = static_cast<char>(flipped[whole.size() - 10] ^ 4);
    save(folder.file("flipped.gim"), flipped);
    const Outcome info = gim({"info", folder.file("flipped.gim")});
    EXPECT_EQ(info.status, 1);
    EXPECT_NE(info.err.find("1 of "), std::string::npos) << info.err;
    EXPECT_NE(info.out.find("DAMAGED"), std::string::npos);

    for (const size_t size : {size_t{3}, size_t{30}, whole.size() / 2, whole.size() - 1}) {
        save(folder.file("cut.gim"), whole.substr(0, size));
        const Outcome decode = gim({"decode", folder.file("cut.gim"), folder.file("cut.ply")});
        EXPECT_EQ(decode.status, 1) << size;
        EXPECT_NE(decode.err.find("cut.gim"), std::string::npos);
        EXPECT_FALSE(std::filesystem::exists(folder.file("cut.ply")));
    }
}

TEST_F(Cli, APrefixDecodesTheCoarseLevels) {
    const json levels = json::parse(gim({"info", gim_path(), "--json"}).out)["images"][0]["levels"];
    const json& coarsest = levels.back();
    save(folder.file("prefix.gim"), load_text(gim_path()).substr(0, coarsest["prefix_bytes"].get<size_t>()));
    const Outcome decode = gim({"decode", folder.file("prefix.gim"), folder.file("coarse.ply"), "--level",
                                std::to_string(coarsest["level"].get<int>())});
    EXPECT_EQ(decode.status, 0) << decode.err;
}

// ---- several charts -------------------------------------------------------------------------------------------------

TEST_F(Cli, ChartsGoAllTheWay) {
    const std::string file = folder.file("charts.gim");
    const Outcome encode = gim({"encode", mesh_path(), file, "--layout", "mcgim", "--samples", "3000", "--charts", "5",
                                "--json", folder.file("report.json")});
    ASSERT_EQ(encode.status, 0) << encode.err;
    const json report = json::parse(load_text(folder.file("report.json")));
    EXPECT_EQ(report["layout"], "mcgim");
    EXPECT_GE(report["charts"], 5);
    EXPECT_LE(report["samples"], 3000);

    const Outcome info = gim({"info", file, "--json"});
    ASSERT_EQ(info.status, 0) << info.err;
    const json description = json::parse(info.out);
    EXPECT_EQ(description["layout"], "mcgim");
    EXPECT_TRUE(description["intact"]);
    const json levels = description["images"][0]["levels"];
    ASSERT_GE(levels.size(), 2U);
    EXPECT_EQ(gim({"info", file}).status, 0);
    for (const json& level : levels) {
        const std::string number = std::to_string(level["level"].get<int>());
        for (const std::string extension : {"ply", "obj", "off", "stl", "glb"}) {
            const std::string path = folder.file("torus" + number + "." + extension);
            const Outcome decode = gim({"decode", file, path, "--level", number});
            ASSERT_EQ(decode.status, 0) << decode.err;
            const Outcome compare = gim({"compare", file, path, "--json", "--samples", "1000"});
            ASSERT_EQ(compare.status, 0) << extension << ": " << compare.err;
            const json topology = json::parse(compare.out)["test"]["topology"];
            EXPECT_TRUE(topology["watertight"]) << extension << " level " << number;
            EXPECT_EQ(topology["genus"], 1) << extension << " level " << number;
            EXPECT_EQ(topology["triangles"], level["triangles"]) << extension << " level " << number;
            EXPECT_EQ(topology["vertices"], level["vertices"]) << extension << " level " << number;
        }
    }
    const Outcome beyond = gim({"decode", file, folder.file("x.ply"), "--level", std::to_string(levels.size())});
    EXPECT_EQ(beyond.status, 1);
    EXPECT_NE(beyond.err.find("coarsest level"), std::string::npos) << beyond.err;
    EXPECT_FALSE(std::filesystem::exists(folder.file("x.ply")));

    // A prefix is enough for a coarse level.
    save(folder.file("prefix.gim"), load_text(file).substr(0, levels.back()["prefix_bytes"].get<size_t>()));
    EXPECT_EQ(gim({"decode", folder.file("prefix.gim"), folder.file("coarse.ply"), "--level",
                   std::to_string(levels.size() - 1)})
                  .status,
              0);
    EXPECT_EQ(gim({"decode", folder.file("prefix.gim"), folder.file("fine.ply")}).status, 1);
}

TEST_F(Cli, UndefinedSamplesAreMaskedInImagesAndAbsentFromMeshes) {
    const std::string file = folder.file("charts.gim"), image = folder.file("charts.exr");
    ASSERT_EQ(
        gim({"encode", mesh_path(), file, "--layout", "mcgim", "--samples", "2000", "--charts", "4", "--quiet"}).status,
        0);
    const json levels = json::parse(gim({"info", file, "--json"}).out)["images"][0]["levels"];
    for (const json& level : {levels.front(), levels.back()}) {
        ASSERT_EQ(gim({"decode", file, image, "--level", std::to_string(level["level"].get<int>())}).status, 0);
        Imf::InputFile exr(image.c_str());
        const Imath::Box2i window = exr.header().dataWindow();
        const auto width = static_cast<size_t>(window.max.x - window.min.x + 1),
                   height = static_cast<size_t>(window.max.y - window.min.y + 1);
        EXPECT_EQ(width, level["width"]);
        EXPECT_EQ(height, level["height"]);
        std::vector<float> x(width * height), mask(width * height);
        Imf::FrameBuffer buffer;
        const auto slice = [&](std::vector<float>& to) {
            return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(to.data()), sizeof(float), sizeof(float) * width);
        };
        buffer.insert("X", slice(x));
        buffer.insert("mask", slice(mask));
        exr.setFrameBuffer(buffer);
        exr.readPixels(window.min.y, window.max.y);
        size_t defined = 0;
        for (size_t i = 0; i < x.size(); ++i) {
            EXPECT_TRUE(mask[i] == 0 || mask[i] == 1);
            EXPECT_EQ(std::isnan(x[i]), mask[i] == 0) << i;
            defined += mask[i] != 0;
        }
        EXPECT_GT(defined, x.size() / 4);
        EXPECT_LT(defined, x.size());
    }
    ASSERT_EQ(gim({"decode", file, folder.file("charts.obj")}).status, 0);
    EXPECT_EQ(load_text(folder.file("charts.obj")).find("nan"), std::string::npos);
    // All numbers of a GLB are four-byte words, and its text is ASCII. None may look like a NaN.
    ASSERT_EQ(gim({"decode", file, folder.file("charts.glb")}).status, 0);
    const std::string glb = load_text(folder.file("charts.glb"));
    for (size_t i = 0; i + 4 <= glb.size(); i += 4) {
        float number = 0;
        std::memcpy(&number, &glb[i], 4);
        ASSERT_FALSE(std::isnan(number)) << i;
    }
}

// ---- what cannot be encoded -----------------------------------------------------------------------------------------

struct Refusal {
    std::string name, content, word;  // `word` must be in the message
};

TEST_F(Cli, WhatIsNoMeshEndsWithAMessageAndNothingBehind) {
    const std::string claim_ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 89478485\nproperty double x\nproperty double y\n"
        "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    std::string claim_stl(80, ' ');
    claim_stl += std::string("\x00\x94\x35\x77", 4) + std::string(16, '\0');
    std::string claim_glb = std::string("glTF\2\0\0\0\0\x94\x35\x77\0\x90\x35\x77JSON", 20) + std::string(80, ' ');
    std::string claim_gim = load_text(gim_path()).substr(0, 100);
    const std::vector<Refusal> refusals = {
        {"empty.ply", "", "the file is empty"},
        {"empty.gim", "", ""},
        {"letter.txt", "Dear all,\nno mesh today.\n", "not a mesh that gim can read"},
        {"letter.obj", "Dear all,\nno mesh today.\n", "not a mesh that gim can read"},
        {"letter.gim", "Dear all,\nno mesh today.\n", "neither a .gim file"},
        {"claim.ply", claim_ply, "claims 89478485"},
        {"claim.off", "OFF\n178956970 1 0\n0 0 0\n", "claims 178956970"},
        {"claim.stl", claim_stl, "claims 2000000000"},
        {"claim.obj", "v 0 0 0\nf 1 2 2000000000\n", "vertex 1"},
        {"claim.glb", claim_glb, "not a mesh that gim can read"},
        {"claim.gim", claim_gim, "gim"},
    };
    for (const Refusal& refusal : refusals) {
        const std::string input = folder.file(refusal.name);
        save(input, refusal.content);
        const std::vector<std::string> before = folder.names();
        const Outcome run = gim({"encode", input, folder.file("out.gim")});
        EXPECT_EQ(run.status, 1) << refusal.name << ": " << run.err;
        EXPECT_NE(run.err.find(input), std::string::npos) << "the message names the file: " << run.err;
        EXPECT_NE(run.err.find(refusal.word), std::string::npos) << refusal.name << ": " << run.err;
        EXPECT_EQ(folder.names(), before) << refusal.name;
    }
}

TEST_F(Cli, HeadersOfGimFilesThatClaimTooMuchAreRefused) {
    // Sets each byte of header and index to its largest value: the program must refuse quickly, with a message.
    const std::string whole = load_text(gim_path());
    for (size_t i = 0; i < 60; i += 3) {
        std::string claim = whole.substr(0, 100);
        claim[i] = '\xff';
        save(folder.file("claim.gim"), claim);
        const Outcome run = gim({"decode", folder.file("claim.gim"), folder.file("claim.ply")});
        EXPECT_EQ(run.status, 1) << i;
        EXPECT_NE(run.err, "") << i;
        EXPECT_FALSE(std::filesystem::exists(folder.file("claim.ply")));
    }
}

TEST_F(Cli, MeshesThatAreRefusedAreDescribed) {
    for (const auto& [name, word] : std::vector<std::pair<std::string, std::string>>{
             {"edge-of-three", "more than two faces"}, {"not-a-number", "finite"}, {"moebius", "only one side"}}) {
        const std::string input = folder.file(name + ".obj");
        save_corpus_mesh(name, input);
        const std::string output = folder.file("out.gim");
        save(output, "an older file");
        const Outcome run = gim({"encode", input, output, "--strict", "--size", "33", "--node-side", "9"});
        EXPECT_EQ(run.status, 1) << name;
        EXPECT_NE(run.err.find(input), std::string::npos) << run.err;
        EXPECT_NE(run.err.find(word), std::string::npos) << name << ": " << run.err;
        EXPECT_EQ(load_text(output), "an older file") << name;
    }
}

TEST_F(Cli, RepairsAreToldAndReported) {
    const std::string input = folder.file("fin.obj"), report = folder.file("report.json");
    save_corpus_mesh("edge-of-three", input);
    const Outcome run = gim({"encode", input, folder.file("out.gim"), "--size", "33", "--json", report});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("warning: 1 edge has more than two faces"), std::string::npos) << run.err;
    EXPECT_NE(run.out.find("1 edge cut open"), std::string::npos) << run.out;
    const json parsed = json::parse(load_text(report));
    EXPECT_EQ(parsed["repairs"]["crowded_edges"], 1);
    EXPECT_EQ(parsed["repairs"]["cut_edges"], 1);
    EXPECT_FALSE(parsed["warnings"].empty());
}

TEST_F(Cli, DebugFolderHoldsAPictureOfEveryStateAndTheirStrip) {
    const std::string input = folder.file("four-pieces.obj");
    save_corpus_mesh("four-pieces", input);
    const std::string pictures = folder.file("new/pictures");
    const Outcome run = gim({"encode", input, folder.file("out.gim"), "--size", "33", "--node-side", "9", "--debug-dir",
                             pictures, "--quiet"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto has = [&](const std::string& part) {
        for (const auto& entry : std::filesystem::directory_iterator(pictures)) {
            if (entry.path().filename().string().find(part) != std::string::npos && entry.file_size() > 1000)
                return true;
        }
        return false;
    };
    for (const char* part : {"strip.png", "component-0-cut-00.png", "component-3-map-even.png",
                             "component-1-map-density.png", "component-2-image-sampled.png", "image-fitted.png"}) {
        EXPECT_TRUE(has(part)) << part;
    }
    save(folder.file("file"), "");
    const Outcome blocked =
        gim({"encode", input, folder.file("other.gim"), "--debug-dir", folder.file("file"), "--quiet"});
    EXPECT_EQ(blocked.status, 1);
    EXPECT_NE(blocked.err.find("folder"), std::string::npos) << blocked.err;
    EXPECT_FALSE(std::filesystem::exists(folder.file("other.gim")));
}

TEST_F(Cli, EveryLevelsPsnrIsToldByEncodeAndByInfo) {
    const json report = json::parse(load_text(shared_folder->file("report.json")));
    const Outcome run = gim({"info", gim_path(), "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const json info = json::parse(run.out);
    const json told = info["level_psnr"];
    ASSERT_EQ(report["levels"].size(), told.size());
    ASSERT_GT(told.size(), 2u);
    for (size_t level = 0; level < told.size(); ++level) {
        const double measured = report["levels"][level]["psnr"];
        EXPECT_NEAR(told[level].get<double>(), measured, 0.8) << level;
        const double rms = report["levels"][level]["rms_error"], largest = report["levels"][level]["max_error"];
        EXPECT_GE(info["level_rms_error"][level].get<double>(), rms) << level;
        EXPECT_GE(info["level_max_error"][level].get<double>(), largest) << level;
        const Outcome compared = gim({"compare", mesh_path(), gim_path(), "--level", std::to_string(level), "--json"});
        EXPECT_NEAR(json::parse(compared.out)["comparison"]["psnr"].get<double>(), measured, 0.1) << level;
    }
}

TEST_F(Cli, CutKeepsTheCoarserLevels) {
    const std::string small = folder.file("small.gim"), from_small = folder.file("a.obj"),
                      from_whole = folder.file("b.obj");
    const Outcome run = gim({"cut", gim_path(), small, "--level", "1"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("from level 1 on"), std::string::npos) << run.out;
    EXPECT_LT(std::filesystem::file_size(small), std::filesystem::file_size(gim_path()));
    EXPECT_EQ(gim({"info", small}).status, 0);
    ASSERT_EQ(gim({"decode", small, from_small}).status, 0);
    ASSERT_EQ(gim({"decode", gim_path(), from_whole, "--level", "1"}).status, 0);
    EXPECT_EQ(load_text(from_small), load_text(from_whole));

    EXPECT_EQ(gim({"cut", gim_path(), small}).status, 2);
    EXPECT_EQ(gim({"cut", gim_path(), small, "--level", "1", "--bytes", "99"}).status, 2);
    EXPECT_EQ(gim({"cut", gim_path(), small, "--drop", "nothing"}).status, 2);
    const Outcome impossible = gim({"cut", gim_path(), folder.file("none.gim"), "--bytes", "99"});
    EXPECT_EQ(impossible.status, 1);
    EXPECT_NE(impossible.err.find("the coarsest level"), std::string::npos) << impossible.err;
    EXPECT_FALSE(std::filesystem::exists(folder.file("none.gim")));
}

TEST_F(Cli, UnwritableOutputsAreFoundBeforeTheWork) {
    save(folder.file("file"), "");
    for (const std::string& output :
         {folder.file("no/such/folder/out.gim"), folder.path(), folder.file("file/out.gim")}) {
        const Outcome run = gim({"encode", mesh_path(), output});
        EXPECT_EQ(run.status, 1);
        EXPECT_NE(run.err.find("cannot write"), std::string::npos) << run.err;
        EXPECT_NE(run.err.find(output), std::string::npos) << run.err;
    }
    const Outcome decode = gim({"decode", gim_path(), folder.file("no/out.ply")});
    EXPECT_EQ(decode.status, 1);
    EXPECT_NE(decode.err.find("cannot write"), std::string::npos);
    if (std::filesystem::exists("/dev/full")) {
        // The results themselves cannot be written.
        const Outcome full = gim({"encode", mesh_path(), "/dev/full", "--size", "33", "--node-side", "9"});
        EXPECT_EQ(full.status, 1) << full.err;
    }
    EXPECT_EQ(folder.names(), std::vector<std::string>{"file"});
}

// A headerless image of a sphere-like surface. Opposite sides of the square differ, so it stays an open patch.
TEST_F(Cli, HeaderlessFloatImagesAreImported) {
    constexpr uint32_t kSide = 33;
    std::string raw;
    for (uint32_t k = 0; k < 3; ++k) {
        for (uint32_t j = 0; j < kSide; ++j) {
            for (uint32_t i = 0; i < kSide; ++i) {
                const float x = static_cast<float>(i) / (kSide - 1);
                const float y = static_cast<float>(j) / (kSide - 1);
                const float value = k == 0 ? x : k == 1 ? y : 0.3F * x * y;
                raw.append(reinterpret_cast<const char*>(&value), sizeof(value));
            }
        }
    }
    save(folder.file("raw.gim"), raw);
    const Outcome encode =
        gim({"encode", folder.file("raw.gim"), folder.file("out.gim"), "--lossless", "--bits", "16"});
    ASSERT_EQ(encode.status, 0) << encode.err;
    const Outcome compare =
        gim({"compare", folder.file("raw.gim"), folder.file("out.gim"), "--json", "--samples", "5000"});
    ASSERT_EQ(compare.status, 0) << compare.err;
    const json result = json::parse(compare.out);
    EXPECT_GT(result["comparison"]["psnr"], 90);
    EXPECT_EQ(result["test"]["topology"]["boundary_loops"], 1);

    save(folder.file("odd.gim"), raw.substr(4));
    const Outcome odd = gim({"encode", folder.file("odd.gim"), folder.file("odd-out.gim")});
    EXPECT_EQ(odd.status, 1);
    EXPECT_NE(odd.err.find("headerless"), std::string::npos) << odd.err;
    EXPECT_FALSE(std::filesystem::exists(folder.file("odd-out.gim")));
}

TEST_F(Cli, GimFilesAreNotEncodedAgain) {
    const Outcome run = gim({"encode", gim_path(), folder.file("twice.gim")});
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.err.find("already"), std::string::npos) << run.err;
    EXPECT_TRUE(folder.names().empty());
}

TEST_F(Cli, MissingInputsAreNamed) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"encode", "no-such.ply", folder.file("a.gim")},
          std::vector<std::string>{"decode", "no-such.ply", folder.file("a.ply")},
          std::vector<std::string>{"info", "no-such.ply"},
          std::vector<std::string>{"compare", "no-such.ply", mesh_path()},
          std::vector<std::string>{"compare", mesh_path(), "no-such.ply"},
          std::vector<std::string>{"render", "no-such.ply", folder.file("a.png")}}) {
        const Outcome run = gim(arguments);
        EXPECT_EQ(run.status, 1) << arguments[0];
        EXPECT_NE(run.err.find("no-such.ply"), std::string::npos) << run.err;
    }
    EXPECT_TRUE(folder.names().empty());
}

TEST_F(Cli, WrongUsageEndsWithStatusTwo) {
    const std::string out = folder.file("a.gim");
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{},
                                               {"no-such-command"},
                                               {"encode"},
                                               {"encode", mesh_path()},
                                               {"encode", mesh_path(), out, "--lossless", "--psnr", "60"},
                                               {"encode", mesh_path(), out, "--bytes", "1000", "--quality", "60"},
                                               {"encode", mesh_path(), out, "--size", "256"},
                                               {"encode", mesh_path(), out, "--size", "-1"},
                                               {"encode", mesh_path(), out, "--bits", "7"},
                                               {"encode", mesh_path(), out, "--bits", "21"},
                                               {"encode", mesh_path(), out, "--psnr", "nan"},
                                               {"encode", mesh_path(), out, "--max-error", ""},
                                               {"encode", mesh_path(), out, "--max-error", "0"},
                                               {"encode", mesh_path(), out, "--max-error", "-1"},
                                               {"encode", mesh_path(), out, "--max-error", "nan"},
                                               {"encode", mesh_path(), out, "--max-error", "inf%"},
                                               {"encode", mesh_path(), out, "--max-error", "%"},
                                               {"encode", mesh_path(), out, "--max-error", "5 %x"},
                                               {"encode", mesh_path(), out, "--max-error", "0.5mm"},
                                               {"encode", mesh_path(), out, "--max-error", "1e400"},
                                               {"encode", mesh_path(), out, "--max-error", "1", "--psnr", "60"},
                                               {"encode", mesh_path(), out, "--max-error", "1", "--lossless"},
                                               {"encode", mesh_path(), out, "--max-error", "1%", "--bytes", "900"},
                                               {"encode", mesh_path(), out, "--max-error", "1%", "--quality", "9"},
                                               {"encode", mesh_path(), out, "--bytes", "0"},
                                               {"encode", mesh_path(), out, "--quality", "101"},
                                               {"encode", mesh_path(), out, "--layout", "spiral"},
                                               {"encode", mesh_path(), out, "--charts", "5000"},
                                               {"encode", mesh_path(), out, "--fit", "tight"},
                                               {"encode", mesh_path(), out, "--threads", "-1"},
                                               {"decode", gim_path(), folder.file("a.xyz")},
                                               {"decode", gim_path(), folder.file("a.ply"), "--level", "-1"},
                                               {"info"},
                                               {"compare", mesh_path()},
                                               {"render", mesh_path(), folder.file("a.png"), "--up", "w"}}) {
        const Outcome run = gim(arguments);
        std::string line;
        for (const std::string& argument : arguments) line.append(" ").append(argument);
        EXPECT_EQ(run.status, 2) << line << "\n" << run.err;
        EXPECT_NE(run.err, "") << line;
    }
    EXPECT_TRUE(folder.names().empty());
}

TEST_F(Cli, HelpAndVersionAreNoErrors) {
    EXPECT_EQ(gim({"--version"}).status, 0);
    EXPECT_EQ(gim({"--version"}).out.find("gim "), 0U);
    EXPECT_EQ(gim({"--help"}).status, 0);
    const Outcome help = gim({"encode", "--help"});
    EXPECT_EQ(help.status, 0);
    for (const char* option :
         {"--layout", "--size", "--samples", "--charts", "--bits", "--lossless", "--psnr", "--max-error", "--bytes",
          "--quality", "--normals", "--seed", "--threads", "--json", "--quiet", "--node-side", "--fit", "--even"}) {
        EXPECT_NE(help.out.find(option), std::string::npos) << option;
    }
}

}  // namespace
}  // namespace gim
