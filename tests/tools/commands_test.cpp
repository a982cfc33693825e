// What every command promises about the files that it is given: names, streams, protections, signals.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/tools/program.h"

namespace gim {
namespace {

using nlohmann::json;
using test::gim;
using test::load_text;
using test::Outcome;
using test::save;
using test::save_corpus_mesh;
using test::Start;
using test::TemporaryFolder;

using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// A small mesh with colours, and its file.
class Commands : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        shared = new TemporaryFolder;
        save_corpus_mesh("torus-576", shared->file("torus.obj"));
        std::string colored;
        std::istringstream lines(load_text(shared->file("torus.obj")));
        for (std::string line; std::getline(lines, line);) colored += line + (line[0] == 'v' ? " 1 0.5 0\n" : "\n");
        save(shared->file("torus.obj"), colored);
        ASSERT_EQ(gim(Words{"encode", shared->file("torus.obj"), shared->file("torus.gim")} + kQuick).status, 0);
    }
    static void TearDownTestSuite() {
        delete shared;
        shared = nullptr;
    }
    void SetUp() override {
        std::filesystem::copy_file(shared->file("torus.obj"), mesh);
        std::filesystem::copy_file(shared->file("torus.gim"), file);
    }

    Words encode(const Words& arguments) const { return Words{"encode"} + arguments + kQuick; }
    // Everything in the folder: names and a hash of the content.
    std::vector<std::string> state() const {
        std::vector<std::string> found;
        for (const std::string& name : folder.names()) {
            const std::string path = folder.file(name);
            const bool is_file = std::filesystem::is_regular_file(path);
            found.push_back(name + (is_file ? " " + std::to_string(std::hash<std::string>()(load_text(path))) : ""));
        }
        return found;
    }

    static inline const Words kQuick = {"--size",    "17", "--fit",    "none", "--normals", "9",
                                        "--threads", "1",  "--colors", "9",    "--quiet"};
    static inline TemporaryFolder* shared = nullptr;
    TemporaryFolder folder;
    const std::string mesh = folder.file("torus.obj"), file = folder.file("torus.gim");
};

// ---- two names of one file ------------------------------------------------------------------------------------------

TEST_F(Commands, TwoNamesOfOneFileAreRefusedBeforeTheWork) {
    std::filesystem::create_hard_link(mesh, folder.file("hard.obj"));
    std::filesystem::create_symlink("torus.obj", folder.file("soft.obj"));
    std::filesystem::create_symlink("new.gim", folder.file("dangling.gim"));
    std::filesystem::create_directory(folder.file("pictures"));
    const std::string again = folder.file("./torus.obj"), fresh = folder.file("new.gim");
    const std::vector<Words> commands = {
        encode({mesh, mesh}),
        encode({mesh, again}),
        encode({mesh, folder.file("hard.obj")}),
        encode({mesh, folder.file("soft.obj")}),
        encode({folder.file("soft.obj"), folder.file("hard.obj")}),
        encode({mesh, fresh, "--json", mesh}),
        encode({mesh, fresh, "--json", again}),
        encode({mesh, fresh, "--json", fresh}),
        encode({mesh, fresh, "--json", folder.file("pictures/../new.gim")}),
        encode({mesh, fresh, "--json", folder.file("dangling.gim")}),
        encode({mesh, fresh, "--debug-dir", fresh}),
        encode({mesh, folder.file("pictures/strip.png"), "--debug-dir", folder.file("pictures")}),
        encode({mesh, folder.file("pictures/01-cut.png"), "--debug-dir", folder.file("pictures")}),
        encode({mesh, fresh, "--json", folder.file("pictures/strip.png"), "--debug-dir", folder.file("pictures")}),
        encode({mesh, "-", "--json", "-"}),
        encode({mesh, "/dev/stdout", "--json", "-"}),
        {"decode", file, file, "--format", "ply"},
        {"decode", file, folder.file("d.obj"), "--color-map", folder.file("c.png"), "--normal-map",
         folder.file("c.png")},
        {"decode", file, folder.file("d.png"), "--format", "stl", "--color-map", folder.file("./d.png")},
        {"compare", "-", "-"},
        {"compare", "-", "/dev/stdin"},
        {"render", "-", folder.file("r.png"), "--gim", "-"},
    };
    const auto before = state();
    for (const Words& command : commands) {
        const Outcome run = gim(command);
        EXPECT_EQ(run.status, 1) << ::testing::PrintToString(command);
        EXPECT_TRUE(contains(run.err, " and ") || contains(run.err, "could replace"))
            << run.err << ::testing::PrintToString(command);
        EXPECT_EQ(run.out, "");
        EXPECT_EQ(state(), before) << ::testing::PrintToString(command);
    }
}

TEST_F(Commands, AnMtlThatReplacesTheInputIsRefused) {
    std::filesystem::rename(file, folder.file("a.mtl"));
    const auto before = state();
    const Outcome run =
        gim({"decode", folder.file("a.mtl"), folder.file("a.obj"), "--color-map", folder.file("c.png")});
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(contains(run.err, ".mtl beside OUT")) << run.err;
    EXPECT_EQ(state(), before);
}

TEST_F(Commands, PicturesOfSeveralImagesKeepToNamesOfTheirOwn) {
    save_corpus_mesh("four-pieces", folder.file("four.obj"));
    const std::string four = folder.file("c-1.exr");  // the name of the second picture
    ASSERT_EQ(gim(encode({folder.file("four.obj"), four})).status, 0);
    const auto before = state();
    const Outcome run = gim({"decode", four, folder.file("d.ply"), "--normal-map", folder.file("c.exr")});
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(contains(run.err, "IN and --normal-map")) << run.err;
    EXPECT_EQ(state(), before);
}

TEST_F(Commands, FilesThatBelongToTheMeshAreNotReplaced) {
    save(mesh, "mtllib the material.mtl\n" + load_text(mesh));
    save(folder.file("the material.mtl"), "newmtl a\nmap_Kd wood.png\n");
    save(folder.file("wood.png"), "a picture");
    save(folder.file("other.png"), "another picture");
    const auto before = state();
    for (const Words& command : {encode({mesh, folder.file("the material.mtl")}),
                                 encode({mesh, folder.file("o.gim"), "--json", folder.file("wood.png")}),
                                 {"render", mesh, folder.file("wood.png"), "--size", "16"}}) {
        const Outcome run = gim(command);
        EXPECT_EQ(run.status, 1);
        EXPECT_TRUE(contains(run.err, "belongs to")) << run.err;
        EXPECT_EQ(state(), before);
    }
    EXPECT_EQ(gim({"render", mesh, folder.file("other.png"), "--size", "16"}).status, 0);
}

TEST_F(Commands, DevicesMayBeNamedTwice) {
    EXPECT_EQ(gim(encode({mesh, "/dev/null", "--json", "/dev/null"})).status, 0);
}

TEST_F(Commands, AForgottenOutDoesNotReplaceTheSecondMesh) {
    save(folder.file("b.ply"), "another mesh");
    const auto before = state();
    const Outcome run = gim(encode({mesh, folder.file("b.ply")}));
    EXPECT_EQ(run.status, 1);
    EXPECT_TRUE(contains(run.err, "did you leave OUT out")) << run.err;
    EXPECT_EQ(state(), before);
}

TEST_F(Commands, SeveralMeshesAreRefusedWithAWayOut) {
    const Outcome run = gim(encode({mesh, mesh, folder.file("out.gim")}));
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(contains(run.err, "one mesh") && contains(run.err, "gim batch")) << run.err;
    const Outcome option = gim(encode({mesh, folder.file("out.gim"), "--no-such-option"}));
    EXPECT_EQ(option.status, 2);
    EXPECT_TRUE(contains(option.err, "--no-such-option")) << option.err;
}

// ---- outputs that cannot be written ---------------------------------------------------------------------------------

TEST_F(Commands, WriteProtectedOutputsAreRefusedByRootToo) {
    save(folder.file("old.gim"), "old");
    save(folder.file("old.ply"), "old");
    ASSERT_EQ(::chmod(folder.file("old.gim").c_str(), 0444), 0);
    ASSERT_EQ(::chmod(folder.file("old.ply").c_str(), 0444), 0);
    const auto before = state();
    for (const Words& command : {encode({mesh, folder.file("old.gim")}),
                                 encode({mesh, folder.file("new.gim"), "--json", folder.file("old.ply")}),
                                 {"decode", file, folder.file("old.ply")}}) {
        const Outcome run = gim(command);
        EXPECT_EQ(run.status, 1);
        EXPECT_TRUE(contains(run.err, "Permission denied")) << run.err;
        EXPECT_EQ(state(), before);
    }
}

// Root may write everything. So the program runs as somebody else.
TEST_F(Commands, WriteProtectedOutputsAreRefused) {
    if (::geteuid() != 0) GTEST_SKIP() << "needs root, to become somebody else";
    constexpr uid_t kNobody = 65534;
    save(folder.file("old.gim"), "old");
    save(folder.file("old.ply"), "old");
    for (const std::string& name : folder.names()) ASSERT_EQ(::chown(folder.file(name).c_str(), kNobody, kNobody), 0);
    ASSERT_EQ(::chown(folder.path().c_str(), kNobody, kNobody), 0);
    ASSERT_EQ(::chmod(folder.file("old.gim").c_str(), 0444), 0);
    ASSERT_EQ(::chmod(folder.file("old.ply").c_str(), 0444), 0);
    Start start;
    start.ready = [] {
        if (::setgid(kNobody) != 0 || ::setuid(kNobody) != 0) ::_exit(126);
    };
    const auto before = state();
    for (const Words& command : {encode({mesh, folder.file("old.gim")}),
                                 encode({mesh, folder.file("new.gim"), "--json", folder.file("old.ply")}),
                                 {"decode", file, folder.file("old.ply")}}) {
        const Outcome run = gim(command, start);
        if (run.status == 126 || run.status == 127) GTEST_SKIP() << "somebody else cannot start the program";
        EXPECT_EQ(run.status, 1);
        EXPECT_TRUE(contains(run.err, "Permission denied")) << run.err;
        EXPECT_EQ(state(), before);
    }
    ASSERT_EQ(::chmod(folder.path().c_str(), 0555), 0);
    const Outcome folder_run = gim(encode({mesh, folder.file("new.gim")}), start);
    EXPECT_EQ(folder_run.status, 1);
    EXPECT_TRUE(contains(folder_run.err, "Permission denied")) << folder_run.err;
    ASSERT_EQ(::chmod(folder.path().c_str(), 0755), 0);
}

TEST_F(Commands, PermissionsAndLinksOfReplacedFilesAreKept) {
    save(folder.file("old.gim"), "old");
    ASSERT_EQ(::chmod(folder.file("old.gim").c_str(), 0640), 0);
    std::filesystem::create_symlink("old.gim", folder.file("link.gim"));
    std::filesystem::create_symlink("fresh.gim", folder.file("dangling.gim"));
    ASSERT_EQ(gim(encode({mesh, folder.file("link.gim")})).status, 0);
    ASSERT_EQ(gim(encode({mesh, folder.file("dangling.gim")})).status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link.gim")));
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("dangling.gim")));
    EXPECT_EQ(load_text(folder.file("old.gim")), load_text(file));
    EXPECT_EQ(load_text(folder.file("fresh.gim")), load_text(file));
    struct stat info = {};
    ASSERT_EQ(::stat(folder.file("old.gim").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777U, 0640U);
}

TEST_F(Commands, MessagesNameTheCause) {
    std::filesystem::create_symlink("loop.gim", folder.file("loop.gim"));
    const auto message = [](const Words& command) {
        const Outcome run = gim(command);
        EXPECT_EQ(run.status, 1);
        return run.err;
    };
    const std::string missing = message(encode({mesh, folder.file("no/such/o.gim")}));
    EXPECT_TRUE(contains(missing, "there is no folder '" + folder.file("no/such") + "'")) << missing;
    for (const auto& [name, cause] :
         std::vector<std::pair<std::string, std::string>>{{"", "Is a directory"},
                                                          {"torus.obj/o.gim", "Not a directory"},
                                                          {"loop.gim", "Too many levels"},
                                                          {std::string(300, 'n') + ".gim", "File name too long"}}) {
        const std::string told = message(encode({mesh, folder.file(name)}));
        EXPECT_TRUE(contains(told, cause)) << told;
        const std::string decoded = message({"decode", file, folder.file(name), "--format", "ply"});
        EXPECT_TRUE(contains(decoded, cause)) << decoded;
    }
    EXPECT_TRUE(contains(message(encode({folder.path(), folder.file("o.gim")})), "Is a directory"));
}

// A result that cannot be told is a failure, and a failure leaves no file.
TEST_F(Commands, ResultsThatAreLostAreFailures) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const auto before = state();
    Words loud = encode({mesh, folder.file("o.gim")});
    loud.pop_back();  // --quiet
    Start full, closed;
    full.out = "/dev/full";
    closed.ready = [] { ::close(STDOUT_FILENO); };
    for (const Words& command : {loud,
                                 loud + Words{"--json", "-"},
                                 {"info", file},
                                 {"info", file, "--json"},
                                 {"decode", file, "-", "--format", "ply"},
                                 {"compare", file, file, "--samples", "1000"},
                                 {"render", file, "-", "--size", "16"},
                                 {"--version"},
                                 {"encode", "--help"}}) {
        for (const Start& start : {full, closed}) {
            const Outcome run = gim(command, start);
            EXPECT_EQ(run.status, 1) << ::testing::PrintToString(command);
            EXPECT_TRUE(contains(run.err, start.ready ? "Bad file descriptor" : "No space left")) << run.err;
            EXPECT_EQ(state(), before) << ::testing::PrintToString(command);
        }
    }
    EXPECT_EQ(gim(encode({mesh, folder.file("o.gim")}), full).status, 0) << "--quiet tells nothing";
}

TEST_F(Commands, ALimitOnTheSizeOfFilesLeavesNothing) {
    Start limited;
    limited.ready = [] {
        const rlimit limit = {1000, 1000};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    };
    save(folder.file("old.ply"), "old");
    const auto before = state();
    for (const std::string name : {"old.ply", "new.ply"}) {
        const Outcome run = gim({"decode", file, folder.file(name)}, limited);
        EXPECT_EQ(run.status, 1);
        EXPECT_TRUE(contains(run.err, "File too large")) << run.err;
        EXPECT_EQ(state(), before);
    }
}

// ---- signals --------------------------------------------------------------------------------------------------------

// Starts a command whose first file is complete but has no name yet, because the second one, a pipe, has no reader.
// Sends the signal then.
int status_after(int signal, const TemporaryFolder& folder, const Words& command, std::vector<std::string>& names) {
    const TemporaryFolder messages;
    Start start;
    start.out = messages.file("out");
    const pid_t child = test::start_gim(command, start, messages.file("err"));
    const auto is_partial = [](const std::string& name) { return contains(name, ".gim-partial-"); };
    // The check before the work makes and removes a file at once. The one that stays is the result.
    int seen = 0;
    for (int i = 0; i < 3000 && seen < 20; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        names = folder.names();
        seen = std::any_of(names.begin(), names.end(), is_partial) ? seen + 1 : 0;
    }
    ::kill(child, signal);
    const int status = test::wait_for(child);
    names = folder.names();
    return status;
}

TEST_F(Commands, SignalsLeaveNothing) {
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
    const auto before = folder.names();
    const Words command = encode({mesh, folder.file("out.gim"), "--json", folder.file("pipe")});
    for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGPIPE, SIGUSR1, SIGALRM, SIGABRT, SIGXCPU}) {
        std::vector<std::string> after;
        EXPECT_EQ(status_after(signal, folder, command, after), -signal);
        EXPECT_EQ(after, before) << signal;
    }
}

TEST_F(Commands, WhatAKillLeavesSaysWhatItIs) {
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
    std::vector<std::string> after;
    EXPECT_EQ(
        status_after(SIGKILL, folder, encode({mesh, folder.file("out.gim"), "--json", folder.file("pipe")}), after),
        -SIGKILL);
    ASSERT_EQ(after.size(), 4U);
    EXPECT_EQ(after[0].find(".out.gim.gim-partial-"), 0U) << after[0];
    EXPECT_EQ(after[0].size(), std::string(".out.gim.gim-partial-XXXXXX").size());
}

TEST_F(Commands, AnIgnoredSignalStaysIgnored) {
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
    Start start;
    const TemporaryFolder messages;
    start.out = messages.file("out");
    start.ready = [] { std::signal(SIGHUP, SIG_IGN); };
    const pid_t child =
        test::start_gim(encode({folder.file("pipe"), folder.file("out.gim")}), start, messages.file("err"));
    const int pipe = ::open(folder.file("pipe").c_str(), O_WRONLY);  // waits for the program
    ::kill(child, SIGHUP);
    const std::string text = load_text(mesh);
    EXPECT_EQ(::write(pipe, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    ::close(pipe);
    EXPECT_EQ(test::wait_for(child), 0);
    EXPECT_EQ(load_text(folder.file("out.gim")), load_text(file));
}

// A reader that goes away ends the program as it ends others, and leaves no file.
TEST_F(Commands, AClosedPipeLeavesNothing) {
    const auto before = state();
    Words loud = encode({mesh, folder.file("o.gim")});
    loud.pop_back();
    Start start;
    start.ready = [] {
        int ends[2];
        if (::pipe(ends) != 0) ::_exit(126);
        ::dup2(ends[1], STDOUT_FILENO);
        ::close(ends[1]);
        ::close(ends[0]);
    };
    for (const Words& command : {loud, encode({mesh, "-"}), {"decode", file, "-", "--format", "ply"}}) {
        EXPECT_EQ(gim(command, start).status, -SIGPIPE);
        EXPECT_EQ(state(), before);
    }
}

// ---- names that are not UTF-8 ---------------------------------------------------------------------------------------

TEST_F(Commands, NamesMayHoldAnyBytes) {
    const std::string odd = folder.file("b\xff\xc3.obj"), out = folder.file("o\xfe\"\x01.gim");
    std::filesystem::rename(mesh, odd);
    const Outcome run = gim(encode({odd, out, "--json", folder.file("report\xfd.json")}));
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(load_text(out), load_text(file));
    const json report = json::parse(load_text(folder.file("report\xfd.json")));
    EXPECT_TRUE(contains(report["input"], "b\xef\xbf\xbd")) << report["input"];
    for (const Words& command : {Words{"info", out, "--json"}, {"compare", odd, out, "--json", "--samples", "1000"}}) {
        const Outcome told = gim(command);
        EXPECT_EQ(told.status, 0) << told.err;
        EXPECT_TRUE(json::accept(told.out)) << told.out;
    }
    EXPECT_EQ(gim({"decode", out, folder.file("d\xff.obj"), "--color-map", folder.file("c\xff.png")}).status, 0);
    EXPECT_TRUE(contains(load_text(folder.file("d\xff.mtl")), "c\xff.png"));
    const Outcome missing = gim({"info", folder.file("no\xff.gim")});
    EXPECT_TRUE(contains(missing.err, "no\xff.gim: ") && contains(missing.err, "No such file")) << missing.err;
}

// ---- streams --------------------------------------------------------------------------------------------------------

TEST_F(Commands, AStreamHoldsTheFileAlone) {
    const std::string bytes = load_text(file);
    Words loud = encode({mesh, "-"});
    loud.pop_back();
    const Outcome run = gim(loud);
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.out, bytes);
    EXPECT_TRUE(contains(run.err, "PSNR")) << "the summary goes to stderr";
    loud[2] = "/dev/stdout";
    EXPECT_EQ(gim(loud).out, bytes);
    loud[2] = "/dev/fd/1";
    EXPECT_EQ(gim(loud).out, bytes);
    loud[2] = folder.file("o.gim");
    const Outcome reported = gim(loud + Words{"--json", "/dev/stdout"});
    EXPECT_TRUE(json::accept(reported.out)) << reported.out;
}

// A stream that is a file goes on where it stands.
TEST_F(Commands, StandardOutputIsAppendedTo) {
    save(folder.file("all"), "head ");
    Start start;
    start.out = folder.file("all");
    start.ready = [] { ::lseek(STDOUT_FILENO, 0, SEEK_END); };
    EXPECT_EQ(gim(encode({mesh, "/dev/stdout"}), start).status, 0);
    EXPECT_EQ(load_text(folder.file("all")), "head " + load_text(file));
}

TEST_F(Commands, EveryCommandReadsStandardInput) {
    Start mesh_in, file_in;
    mesh_in.in = mesh;
    file_in.in = file;
    for (const std::string name : {"-", "/dev/stdin", "/dev/fd/0"}) {
        EXPECT_EQ(gim(encode({name, "-", "--format", "obj"}), mesh_in).out, load_text(file)) << name;
        EXPECT_EQ(gim({"info", name}, file_in).status, 0);
        const Outcome compared = gim({"compare", mesh, name, "--samples", "1000", "--json"}, file_in);
        EXPECT_EQ(compared.status, 0) << compared.err;
        EXPECT_EQ(gim({"compare", name, file, "--samples", "1000", "--format", "obj"}, mesh_in).status, 0);
        EXPECT_EQ(gim({"render", name, folder.file("a.png"), "--size", "16"}, file_in).status, 0);
        EXPECT_EQ(gim({"render", mesh, folder.file("a.png"), "--size", "16", "--gim", name}, file_in).status, 0);
        const Outcome decoded = gim({"decode", name, "-", "--format", "obj"}, file_in);
        EXPECT_EQ(decoded.status, 0) << decoded.err;
        EXPECT_EQ(decoded.out.find("# decoded by gim"), 0U);
    }
    EXPECT_TRUE(contains(gim({"info", "-"}, file_in).out, "standard input"));
    EXPECT_EQ(gim({"render", file, "-", "--size", "16"}).out.substr(1, 3), "PNG");
}

TEST_F(Commands, FormatTellsWhatTheNameDoesNot) {
    for (const std::string format : {"ply", "obj", "off", "stl", "glb", "exr"}) {
        const std::string named = folder.file("named." + format);
        ASSERT_EQ(gim({"decode", file, named}).status, 0);
        EXPECT_EQ(gim({"decode", file, "-", "--format", format}).out, load_text(named)) << format;
        EXPECT_EQ(gim({"decode", file, folder.file("plain"), "--format", format}).status, 0);
        EXPECT_EQ(load_text(folder.file("plain")), load_text(named)) << format;
        if (format == "exr") continue;
        const Outcome read = gim({"compare", file, folder.file("plain"), "--format", format, "--samples", "1000"});
        EXPECT_EQ(read.status, 0) << format << read.err;
    }
    EXPECT_EQ(gim({"decode", file, "-", "--format", "STL"}).status, 0);
    EXPECT_EQ(gim({"decode", file, "-"}).status, 2);
    EXPECT_EQ(gim({"decode", file, folder.file("plain")}).status, 2);
    EXPECT_EQ(gim({"decode", file, "-", "--format", "doc"}).status, 2);
    EXPECT_EQ(gim(encode({mesh, "-", "--format", "doc"})).status, 2);
    // The content decides unless told otherwise.
    std::filesystem::rename(folder.file("named.off"), folder.file("wrong.stl"));
    EXPECT_EQ(gim(encode({folder.file("wrong.stl"), folder.file("o.gim")})).status, 0);
    EXPECT_EQ(gim(encode({folder.file("wrong.stl"), folder.file("o.gim"), "--format", "stl"})).status, 1);
}

TEST_F(Commands, NamedPipesAreReadAndWritten) {
    ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
    const TemporaryFolder messages;
    Start start;
    start.out = messages.file("out");
    const pid_t writer = test::start_gim(encode({mesh, folder.file("pipe")}), start, messages.file("err"));
    const Outcome reader = gim({"info", folder.file("pipe")});
    EXPECT_EQ(reader.status, 0) << reader.err;
    EXPECT_EQ(test::wait_for(writer), 0);
}

// ---- sizes ----------------------------------------------------------------------------------------------------------

TEST_F(Commands, EverySmallSizeIsEncoded) {
    for (const std::string size : {"9", "17", "33"}) {
        const Words sized = {"encode", mesh, folder.file("o.gim"), "--size", size, "--fit", "none", "--quiet"};
        const Outcome run = gim(sized);
        EXPECT_EQ(run.status, 0) << size << run.err;
        for (const std::string side : {"5", "9", "17", "33", "65"}) {
            const Outcome with_side = gim(sized + Words{"--node-side", side});
            EXPECT_EQ(with_side.status, 0) << size << ", node side " << side << ": " << with_side.err;
        }
    }
    EXPECT_EQ(gim({"encode", mesh, folder.file("o.gim"), "--node-side", "3"}).status, 2);
}

TEST_F(Commands, TooFewBytesNameTheSameLeastSizeAndThatSizeIsInReach) {
    const auto message = [&](const std::string& bytes) {
        const Outcome run =
            gim({"encode", mesh, folder.file("o.gim"), "--size", "17", "--threads", "1", "--bytes", bytes});
        EXPECT_EQ(run.status, 1) << bytes;
        return run.err.substr(run.err.find("the smallest file"));
    };
    const std::string least = message("1");
    const size_t number = least.find("has ") + 4;
    const int bytes = std::stoi(least.substr(number));
    EXPECT_GT(bytes, 20);
    EXPECT_EQ(message("50"), least);
    const std::string enough = std::to_string(bytes);
    EXPECT_EQ(gim({"encode", mesh, folder.file("o.gim"), "--size", "17", "--threads", "1", "--bytes", enough}).status,
              0);
    EXPECT_LE(std::filesystem::file_size(folder.file("o.gim")), static_cast<uintmax_t>(bytes));
}

}  // namespace
}  // namespace gim
