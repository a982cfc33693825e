// gim batch as its users run it.
#include <gtest/gtest.h>

#include <set>

#include "tests/tools/batch_files.h"

namespace gim {
namespace {

using namespace test;
namespace fs = std::filesystem;

class Batch : public ::testing::Test {
  protected:
    const TemporaryFolder folder;
    const std::string meshes = folder.file("meshes"), out = folder.file("out");

    Outcome run(const std::vector<std::string>& more = {}) const { return gim(batch_arguments(meshes, out, more)); }
};

TEST_F(Batch, KeepsWhatIsDoneAndDoesAgainWhatChanged) {
    save_many_meshes(meshes, 6);
    Outcome outcome = run();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(count_results(outcome.out, "encoded"), 6U);

    outcome = run({"--threads", "2", "--jobs", "3", "--max-memory", "1G"});
    EXPECT_EQ(count_results(outcome.out, "kept"), 6U) << "options that do not change bytes";

    save(meshes + "/0/3.obj", obj_text(dented_sphere(100)));
    fs::remove(out + "/0/4.obj.gim");
    save(out + "/0/5.obj.gim", "damaged");
    outcome = run();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(count_results(outcome.out, "kept"), 3U);
    EXPECT_EQ(count_results(outcome.out, "encoded"), 3U);

    outcome = run({"--bits", "10"});
    EXPECT_EQ(count_results(outcome.out, "encoded"), 6U);
    outcome = run({"--bits", "10"});
    EXPECT_EQ(count_results(outcome.out, "kept"), 6U);
}

TEST_F(Batch, FilesOfOneStemKeepTheirExtensions) {
    fs::create_directories(meshes);
    save_corpus_mesh("sphere-108", meshes + "/a.obj");
    save(meshes + "/a.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
    EXPECT_EQ(run().status, 0);
    EXPECT_EQ(files_below(out, ".gim"), (std::vector<std::string>{"a.obj.gim", "a.off.gim"}));
}

TEST_F(Batch, BadInputsAreListedAndStopNothing) {
    fs::create_directories(meshes + "/folder.ply");
    save_corpus_mesh("sphere-108", meshes + "/good.obj");
    save(meshes + "/empty.ply", "");
    save(meshes + "/text.obj", "this is no mesh\n");
    save(meshes + "/cut.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n");
    save(meshes + "/huge.ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
         "property float y\nproperty float z\nelement face 4000000000\n"
         "property list uchar int vertex_indices\nend_header\n");
    save(meshes + "/nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    save(meshes + "/flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    save(meshes + "/no-buffer.gltf",
         R"({"asset":{"version":"2.0"},"buffers":[{"uri":"gone.bin","byteLength":36}],"meshes":[]})");
    fs::create_symlink("gone.ply", meshes + "/dangling.ply");
    ::mkfifo((meshes + "/pipe.ply").c_str(), 0600);
    std::string list;
    const std::vector<std::string> bad = {"empty.ply",      "text.obj",     "cut.ply",    "huge.ply",
                                          "nan.obj",        "flat.obj",     "folder.ply", "pipe.ply",
                                          "no-buffer.gltf", "dangling.ply", "missing.stl"};
    for (const std::string& name : bad) list += meshes + "/" + name + "\n";
    list += meshes + "/good.obj\n";
    save(folder.file("list"), list);
    ASSERT_EQ(gim({"encode", meshes + "/good.obj", meshes + "/packed.off", "--size", "17"}).status, 1);

    const Outcome outcome = gim(batch_arguments(folder.file("list"), out));
    EXPECT_EQ(outcome.status, 1);
    std::map<std::string, std::string> reasons;
    for (const auto& line : log_lines(outcome.out)) {
        if (line.at("result") == "failed")
            reasons[fs::path(line.at("input").get<std::string>()).filename()] = line.at("reason");
    }
    EXPECT_EQ(reasons.size(), bad.size());
    for (const std::string& name : bad) EXPECT_GT(reasons[name].size(), 10U) << name;
    EXPECT_EQ(count_results(outcome.out, "encoded"), 1U);
    EXPECT_EQ(files_below(out, ".gim").size(), 1U);
    EXPECT_EQ(count_partial_files(out), 0U);
    const std::string page = load_text(out + "/report.html");
    for (const std::string& name : bad) EXPECT_NE(page.find(name), std::string::npos) << name;
}

TEST_F(Batch, ARepairedInputIsDoneByTheNextRun) {
    fs::create_directories(meshes);
    save(meshes + "/a.obj", "nothing\n");
    EXPECT_EQ(run().status, 1);
    save_corpus_mesh("sphere-108", meshes + "/a.obj");
    const Outcome outcome = run();
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(count_results(outcome.out, "encoded"), 1U);
}

TEST_F(Batch, ShardsGiveWhatOneRunGives) {
    save_many_meshes(meshes, 23);
    ASSERT_EQ(run().status, 0);
    const std::string shared = folder.file("shared");
    std::vector<pid_t> shards;
    for (const char* shard : {"1/3", "2/3", "3/3"}) {
        Start start;
        start.out = folder.file(std::string("log") + shard[0]);
        shards.push_back(start_gim(batch_arguments(meshes, shared, {"--shard", shard, "--jobs", "1"}), start,
                                   folder.file(std::string("err") + shard[0])));
    }
    for (const pid_t process : shards) EXPECT_EQ(wait_for(process), 0);
    size_t encoded = 0;
    for (const char* name : {"log1", "log2", "log3"}) encoded += count_results(load_text(folder.file(name)), "encoded");
    EXPECT_EQ(encoded, 23U);
    ASSERT_EQ(files_below(shared, ".gim"), files_below(out, ".gim"));
    for (const std::string& name : files_below(out, ".gim"))
        EXPECT_EQ(load_text(shared + "/" + name), load_text(out + "/" + name)) << name;
    // The last to end reports all of them.
    const std::string page = load_text(shared + "/report.html");
    EXPECT_EQ(page.find("waiting"), std::string::npos);
    for (int i = 0; i < 23; ++i) EXPECT_NE(page.find("/" + std::to_string(i) + ".obj</td>"), std::string::npos) << i;
    // Another split takes over what is done.
    EXPECT_EQ(count_results(gim(batch_arguments(meshes, shared)).out, "kept"), 23U);
    EXPECT_EQ(count_results(gim(batch_arguments(meshes, shared, {"--shard", "2/2"})).out, "kept"), 11U);
}

TEST_F(Batch, OneShardRunsOnceAtATime) {
    save_many_meshes(meshes, 1);
    ASSERT_EQ(run().status, 0);
    const Result<Manifest> held = Manifest::open(out + "/gim-batch-1-of-1.sqlite");
    ASSERT_TRUE(held.ok());
    const Outcome outcome = run();
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("another gim batch"), std::string::npos) << outcome.err;
}

TEST_F(Batch, ShardsOfTwoSplitsDoNotRunAtATime) {
    save_many_meshes(meshes, 2);
    ASSERT_EQ(run({"--shard", "1/2"}).status, 0);
    std::optional<Result<Manifest>> held = Manifest::open(out + "/gim-batch-1-of-2.sqlite");
    ASSERT_TRUE(held->ok());
    Outcome outcome = run();
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("another --shard"), std::string::npos) << outcome.err;
    EXPECT_EQ(files_below(out, ".gim").size(), 1U);
    outcome = run({"--shard", "2/2"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    held.reset();
    outcome = run();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(count_results(outcome.out, "kept"), 2U);
}

TEST_F(Batch, TheLogGoesIntoNoInput) {
    save_many_meshes(meshes, 1);
    const std::string mesh = meshes + "/0/0.obj", list = folder.file("list");
    save(list, mesh + "\n");
    const std::string before = load_text(mesh);
    for (const std::string& log : {mesh, list}) {
        const Outcome outcome = gim(batch_arguments(list, out, {"--log", log}));
        EXPECT_EQ(outcome.status, 1);
        EXPECT_NE(outcome.err.find("this is an input"), std::string::npos) << outcome.err;
    }
    EXPECT_EQ(load_text(mesh), before);
    EXPECT_EQ(load_text(list), mesh + "\n");
}

TEST_F(Batch, NoOutputReplacesAnInput) {
    fs::create_directories(meshes);
    save_corpus_mesh("sphere-108", meshes + "/a.obj");
    save(meshes + "/a.obj.gim", "an image");
    save(folder.file("list"), meshes + "/a.obj\n" + meshes + "/a.obj.gim\n");
    const Outcome outcome = gim(batch_arguments(folder.file("list"), "/"));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("would replace"), std::string::npos) << outcome.err;
    EXPECT_EQ(load_text(meshes + "/a.obj.gim"), "an image");
}

TEST_F(Batch, WrongUsage) {
    save_many_meshes(meshes, 1);
    for (const char* shard : {"0/2", "3/2", "1", "1/", "a/b", "1/2/3"})
        EXPECT_EQ(run({"--shard", shard}).status, 2) << shard;
    EXPECT_EQ(run({"--psnr", "60"}).status, 2) << "two rates";
    EXPECT_EQ(run({"--jobs", "0"}).status, 2);
    EXPECT_EQ(gim({"batch", folder.file("missing"), out}).status, 1);
    fs::create_directories(folder.file("none"));
    EXPECT_EQ(gim({"batch", folder.file("none"), out}).status, 1);
    EXPECT_FALSE(fs::exists(out));
}

TEST_F(Batch, AFullLogIsAFailure) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    save_many_meshes(meshes, 2);
    const Outcome outcome = run({"--log", "/dev/full"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("/dev/full"), std::string::npos) << outcome.err;
    EXPECT_EQ(files_below(out, ".gim").size(), 2U);
}

TEST_F(Batch, TheSummaryCountsAndNamesFailures) {
    save_many_meshes(meshes, 2);
    save(meshes + "/bad.ply", "");
    std::vector<std::string> arguments = {"batch",  meshes, out,     "--layout",        "gim",
                                          "--size", "17",   "--log", folder.file("log")};
    const Outcome outcome = gim(arguments);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.out.find("files           3\n"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("encoded         2\n"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("failed          1\n"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("bad.ply: "), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace gim
