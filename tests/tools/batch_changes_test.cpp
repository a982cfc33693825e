// gim batch, when inputs, names, folders or the disk change between two runs.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>

#include "tests/encoder/raster/made_rasters.h"
#include "tests/tools/batch_files.h"
#include "tools/raster_file.h"

namespace gim {
namespace {

using namespace test;
namespace fs = std::filesystem;
using State = BatchRow::State;

class BatchChanges : public ::testing::Test {
  protected:
    const TemporaryFolder folder;
    const std::string meshes = folder.file("meshes"), out = folder.file("out");
    const std::string manifest = out + "/gim-batch-1-of-1.sqlite";

    Outcome run(const std::vector<std::string>& more = {}) const { return gim(batch_arguments(meshes, out, more)); }
};

TEST_F(BatchChanges, AnInputThatComesBackIsNotEncodedAgain) {
    save_many_meshes(meshes, 3);
    ASSERT_EQ(run().status, 0);
    const std::string mesh = meshes + "/0/1.obj", text = load_text(mesh), before = load_text(out + "/0/1.obj.gim");
    save(mesh, "no mesh\n");
    EXPECT_EQ(run().status, 1);
    EXPECT_EQ(manifest_rows(manifest)[1].state, State::kFailed);
    EXPECT_EQ(load_text(out + "/0/1.obj.gim"), before);

    save(mesh, text);
    Outcome outcome = run();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(count_results(outcome.out, "kept"), 3U);
    const BatchRow row = manifest_rows(manifest)[1];
    EXPECT_EQ(row.state, State::kDone);
    EXPECT_EQ(row.encodes, 1U);
    EXPECT_EQ(row.reason, "");
    EXPECT_EQ(row.figures.bytes, before.size());

    // Not if its output has gone.
    save(mesh, "no mesh\n");
    EXPECT_EQ(run().status, 1);
    fs::remove(out + "/0/1.obj.gim");
    save(mesh, text);
    outcome = run();
    EXPECT_EQ(count_results(outcome.out, "encoded"), 1U);
    EXPECT_EQ(load_text(out + "/0/1.obj.gim"), before);
}

TEST_F(BatchChanges, PathsOfAListBeginAtTheCurrentFolder) {
    save_many_meshes(meshes, 2);
    save(folder.file("list"), "0/0.obj\n0/1.obj\n");
    fs::create_directories(folder.file("elsewhere"));
    Start here, elsewhere;
    here.ready = [&] { (void)!::chdir(meshes.c_str()); };
    elsewhere.ready = [&] { (void)!::chdir(folder.file("elsewhere").c_str()); };
    const std::vector<std::string> arguments = batch_arguments(folder.file("list"), out);
    ASSERT_EQ(gim(arguments, here).status, 0);
    EXPECT_EQ(count_results(gim(arguments, elsewhere).out, "failed"), 2U);
    EXPECT_EQ(files_below(out, ".gim").size(), 2U);
    EXPECT_EQ(count_results(gim(arguments, here).out, "kept"), 2U);
}

TEST_F(BatchChanges, WhatAKillLeftOfADoneInputIsRemoved) {
    save_many_meshes(meshes, 1);
    ASSERT_EQ(run().status, 0);
    save(out + "/0/.0.obj.gim.gim-partial-abcdef", "part of a file");
    save(out + "/0/.other.gim.gim-partial-abcdef", "part of a file of another program");
    save(out + "/0/.0.obj.gim", "a file of the user");
    EXPECT_EQ(count_results(run().out, "kept"), 1U);
    EXPECT_FALSE(fs::exists(out + "/0/.0.obj.gim.gim-partial-abcdef"));
    EXPECT_TRUE(fs::exists(out + "/0/.other.gim.gim-partial-abcdef"));
    EXPECT_TRUE(fs::exists(out + "/0/.0.obj.gim"));
}

TEST_F(BatchChanges, OddNamesAreNames) {
    fs::create_directories(meshes);
    for (const char* name : {"-a.obj", "--jobs.obj", "two\nlines.obj", "no\xFFutf8.obj", "a\"quote'.obj", "% \\.obj",
                             "\xC3\xA9.obj", "~.obj", "<b>.obj"})
        save(meshes + "/" + name, obj_text(dented_sphere(1)));
    Outcome outcome = run();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(count_results(outcome.out, "encoded"), 9U);
    EXPECT_EQ(files_below(out, ".gim").size(), 9U);
    EXPECT_TRUE(fs::exists(out + "/no\xFFutf8.obj.gim"));
    outcome = run();
    EXPECT_EQ(count_results(outcome.out, "kept"), 9U);
}

TEST_F(BatchChanges, ImagesOfOtherProgramsStayAsTheyStand) {
    const RasterImage image = raster_of(18, 13, with_holes, 3);
    fs::create_directories(meshes);
    for (const RasterFormat format : {RasterFormat::kNpz, RasterFormat::kExr}) {
        RasterImage typed = image;
        typed.type = format == RasterFormat::kNpz ? SampleType::kUint16 : SampleType::kUint32;
        const Result<Bytes> bytes = write_raster_file(typed, format);
        ASSERT_TRUE(bytes.ok());
        save(meshes + (format == RasterFormat::kNpz ? "/a.npz" : "/b.exr"),
             {reinterpret_cast<const char*>(bytes.value().data()), bytes.value().size()});
    }
    save(meshes + "/c.npz", "no archive");
    save(folder.file("list"), meshes + "/a.npz\n" + meshes + "/b.exr\n" + meshes + "/c.npz\n");
    Outcome outcome = gim({"batch", folder.file("list"), out, "--lossless", "--quiet"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(count_results(outcome.out, "encoded"), 2U) << outcome.out;
    EXPECT_EQ(count_results(outcome.out, "failed"), 1U);
    for (const std::string& name : files_below(out, ".gim")) {
        EXPECT_EQ(gim({"decode", out + "/" + name, folder.file("back.npz")}).status, 0) << name;
        MemoryBudget memory(1 << 26);
        const Result<Bytes> back = read_file(folder.file("back.npz"));
        ASSERT_TRUE(back.ok());
        const Result<RasterImage> read = read_raster(back.value(), RasterFormat::kNpz, {}, memory);
        ASSERT_TRUE(read.ok()) << read.error().message;
        EXPECT_EQ(read.value().values, image.values);
        EXPECT_EQ(read.value().defined, image.defined);
    }
    // Another layout cannot hold it, and says so.
    outcome = gim({"batch", folder.file("list"), folder.file("squares"), "--layout", "gim", "--quiet"});
    EXPECT_EQ(count_results(outcome.out, "failed"), 3U);
    EXPECT_NE(outcome.out.find("mcgim"), std::string::npos) << outcome.out;
}

// No file may grow beyond 64 kB, so the manifest cannot take all rows.
TEST_F(BatchChanges, ADiskThatIsFullLosesNothing) {
    constexpr size_t kMeshes = 30;
    save_many_meshes(meshes, kMeshes);
    Start full;
    full.ready = [] {
        const rlimit limit = {64000, 64000};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    };
    Outcome outcome = gim(batch_arguments(meshes, out, {"--thumbnails", "256"}), full);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find(".sqlite"), std::string::npos) << outcome.err;
    const size_t encoded = count_results(outcome.out, "encoded");
    EXPECT_LT(encoded, kMeshes);
    EXPECT_EQ(count_results(outcome.out, "failed"), 0U);

    outcome = run({"--thumbnails", "256"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_GE(count_results(outcome.out, "kept"), encoded);
    EXPECT_EQ(files_below(out, ".gim").size(), kMeshes);
    EXPECT_EQ(count_partial_files(out), 0U);
    for (const BatchRow& row : manifest_rows(manifest)) EXPECT_EQ(row.encodes, 1U) << row.name;
}

}  // namespace
}  // namespace gim
