// write_file if the system refuses in the middle.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#include "tests/tools/test_files.h"
#include "tools/file.h"

namespace gim {
namespace {

using test::load_text;
using test::save;
using test::TemporaryFolder;

// While it lives, no file of this process can grow beyond `bytes`: one write is cut short, the next one fails.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        holds_ = ::getrlimit(RLIMIT_FSIZE, &before_) == 0;
        const rlimit limit = {bytes, before_.rlim_max};
        holds_ = holds_ && ::setrlimit(RLIMIT_FSIZE, &limit) == 0;
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

    bool holds() const { return holds_; }

  private:
    void (*handler_)(int);
    rlimit before_ = {};
    bool holds_ = false;
};

Result<void> write_beyond_the_limit(const std::string& path) {
    const FileSizeLimit limit(1000);
    EXPECT_TRUE(limit.holds());
    return write_file(path, Bytes(5000, 'n'));
}

TEST(FailedWrite, KeepsTheOldFileAndLeavesNothingElse) {
    const TemporaryFolder folder;
    save(folder.file("a.bin"), "old");
    const Result<void> written = write_beyond_the_limit(folder.file("a.bin"));
    ASSERT_FALSE(written.ok());
    EXPECT_EQ(written.error().stage, Stage::kWrite);
    EXPECT_EQ(written.error().message.find("cannot write: "), 0U) << written.error().message;
    EXPECT_EQ(load_text(folder.file("a.bin")), "old");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.bin"});
}

TEST(FailedWrite, OfANewFileLeavesNothing) {
    const TemporaryFolder folder;
    EXPECT_FALSE(write_beyond_the_limit(folder.file("a.bin")).ok());
    EXPECT_TRUE(folder.names().empty());
}

// A reader that has the old file open while it is replaced goes on reading the old bytes.
TEST(FailedWrite, ReadersOfTheOldFileDoNotSeeTheNewOne) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.bin");
    save(path, "old bytes");
    const int reader = ::open(path.c_str(), O_RDONLY);
    ASSERT_GE(reader, 0);
    ASSERT_TRUE(write_file(path, Bytes(5000, 'n')).ok());
    char text[64] = {};
    EXPECT_EQ(::read(reader, text, sizeof text), 9);
    EXPECT_STREQ(text, "old bytes");
    ::close(reader);
    EXPECT_EQ(load_text(path), std::string(5000, 'n'));
}

}  // namespace
}  // namespace gim
