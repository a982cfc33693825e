// gim batch, killed and restarted.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "tests/tools/batch_files.h"

namespace gim {
namespace {

using namespace test;
using State = BatchRow::State;
using std::chrono::milliseconds;

bool has_ended(pid_t process) {
    siginfo_t info = {};
    return ::waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == process;
}

// Waits until the folder has so many outputs, or the program has ended.
void wait_for_outputs(pid_t process, const std::string& out, size_t count) {
    while (!has_ended(process) && files_below(out, ".gim").size() < count) std::this_thread::sleep_for(milliseconds(2));
}

// A file that is written again has another number, or another time.
std::map<std::string, std::pair<ino_t, int64_t>> identities(const std::string& out) {
    std::map<std::string, std::pair<ino_t, int64_t>> found;
    for (const std::string& name : files_below(out, ".gim")) {
        struct stat info = {};
        if (::stat((out + "/" + name).c_str(), &info) == 0)
            found[name] = {info.st_ino, info.st_mtim.tv_sec * 1000000000LL + info.st_mtim.tv_nsec};
    }
    return found;
}

class BatchKill : public ::testing::Test {
  protected:
    const TemporaryFolder folder;
    const std::string meshes = folder.file("meshes"), out = folder.file("out"), log = folder.file("log");

    pid_t start() const {
        Start start;
        start.out = folder.file("stdout");
        start.ready = [] {  // the tests may run where signals are ignored (nohup)
            for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
        };
        return start_gim(batch_arguments(meshes, out, {"--log", log, "--jobs", "2"}), start, folder.file("stderr"));
    }
    void expect_all_done_once(size_t count) const {
        const std::vector<BatchRow> rows = manifest_rows(out + "/gim-batch-1-of-1.sqlite");
        EXPECT_EQ(rows.size(), count);
        for (const BatchRow& row : rows) {
            EXPECT_EQ(row.state, State::kDone) << row.name;
            EXPECT_EQ(row.encodes, 1U) << row.name;
            EXPECT_TRUE(row.partial.empty()) << row.name;
            EXPECT_EQ(std::filesystem::file_size(out + "/" + row.name + ".gim"), row.figures.bytes) << row.name;
        }
        EXPECT_EQ(files_below(out, ".gim").size(), count);
        EXPECT_EQ(count_partial_files(out), 0U);
        std::map<std::string, int> encoded;
        for (const auto& line : log_lines(load_text(log))) encoded[line.at("input")] += line.at("result") == "encoded";
        for (const auto& [input, times] : encoded) EXPECT_LE(times, 1) << input;
    }
};

TEST_F(BatchKill, TenKillsLoseNothingAndRepeatNothing) {
    constexpr size_t kMeshes = 200, kKills = 10;
    save_many_meshes(meshes, kMeshes);
    std::minstd_rand random(20261130);
    auto before = identities(out);
    for (size_t kill = 1; kill <= kKills; ++kill) {
        const pid_t process = start();
        wait_for_outputs(process, out, kill * 15);
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 40000));
        ::kill(process, SIGKILL);
        EXPECT_EQ(wait_for(process), -SIGKILL) << "all was done before kill " << kill;
        const auto now = identities(out);
        for (const auto& [name, identity] : before) {
            ASSERT_TRUE(now.contains(name)) << name;
            EXPECT_EQ(now.at(name), identity) << name << " was written again";
        }
        before = now;
        EXPECT_LT(before.size(), kMeshes);
    }
    EXPECT_EQ(wait_for(start()), 0) << load_text(folder.file("stderr"));
    for (const auto& [name, identity] : before) EXPECT_EQ(identities(out).at(name), identity) << name;
    expect_all_done_once(kMeshes);
    // The bytes are those of gim encode.
    std::vector<std::string> encode = {"encode", meshes + "/7/77.obj", folder.file("77.gim"), "--quiet"};
    encode.insert(encode.end(), kQuickEncode.begin(), kQuickEncode.end());
    ASSERT_EQ(gim(encode).status, 0);
    EXPECT_EQ(load_text(folder.file("77.gim")), load_text(out + "/7/77.obj.gim"));
}

TEST_F(BatchKill, ASignalEndsARunInOrder) {
    constexpr size_t kMeshes = 60;
    save_many_meshes(meshes, kMeshes);
    size_t outputs = 5;
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        const pid_t process = start();
        wait_for_outputs(process, out, outputs += 5);
        ::kill(process, signal);
        EXPECT_EQ(wait_for(process), 128 + signal);
        for (const BatchRow& row : manifest_rows(out + "/gim-batch-1-of-1.sqlite"))
            EXPECT_TRUE(row.state == State::kDone || row.state == State::kWaiting) << row.name;
        EXPECT_EQ(count_partial_files(out), 0U);
        EXPECT_TRUE(std::filesystem::exists(out + "/report.html"));
    }
    EXPECT_EQ(wait_for(start()), 0);
    expect_all_done_once(kMeshes);
}

// The first child of a process. 0 if there is none, -1 if the system does not tell.
pid_t child_of(pid_t process) {
    const std::string number = std::to_string(process);
    std::ifstream in("/proc/" + number + "/task/" + number + "/children");
    if (!in) return -1;
    pid_t child = 0;
    in >> child;
    return child;
}

TEST_F(BatchKill, AnEncoderThatIsKilledIsAFailureOfItsInputAlone) {
    if (child_of(::getpid()) < 0) GTEST_SKIP() << "this system does not tell the children of a process";
    save_many_meshes(meshes, 30);
    const pid_t process = start();
    pid_t child = 0;
    while (child <= 0 && !has_ended(process)) child = child_of(process);
    ASSERT_GT(child, 0);
    ::kill(child, SIGKILL);
    EXPECT_EQ(wait_for(process), 1);
    const std::string text = load_text(log);
    EXPECT_EQ(count_results(text, "encoded"), 29U);
    ASSERT_EQ(count_results(text, "failed"), 1U);
    for (const auto& line : log_lines(text)) {
        if (line.at("result") == "failed") {
            EXPECT_NE(line.at("reason").get<std::string>().find("signal 9"), std::string::npos);
        }
    }
    EXPECT_EQ(count_partial_files(out), 0U);
    EXPECT_EQ(wait_for(start()), 0);
    expect_all_done_once(30);
}

}  // namespace
}  // namespace gim
