#include "tools/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/tools/test_files.h"

namespace gim {
namespace {

using test::load_text;
using test::save;
using test::TemporaryFolder;
using test::to_bytes;

TEST(File, WritingReplacesTheWholeFileAndLeavesNothingElse) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.bin");
    save(path, "a longer old content");
    ASSERT_TRUE(write_file(path, to_bytes("new")).ok());
    EXPECT_EQ(load_text(path), "new");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.bin"});
    const Result<Bytes> read = read_file(path);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read.value(), to_bytes("new"));
}

TEST(File, WritingKeepsThePermissionsOfTheOldFileAndFollowsLinks) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.bin");
    save(path, "old");
    ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
    std::filesystem::create_symlink("a.bin", folder.file("link.bin"));
    ASSERT_TRUE(write_file(folder.file("link.bin"), to_bytes("new")).ok());
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link.bin")));
    EXPECT_EQ(load_text(path), "new");
    struct stat info = {};
    ASSERT_EQ(::stat(path.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777U, 0640U);
}

TEST(File, MissingFoldersAndFoldersInTheWayAreRefused) {
    const TemporaryFolder folder;
    for (const std::string& path : {folder.file("no/such/a.bin"), folder.path()}) {
        const Result<void> writable = check_writable(path);
        ASSERT_FALSE(writable.ok());
        EXPECT_EQ(writable.error().message.find("cannot write: "), 0U) << writable.error().message;
        EXPECT_FALSE(write_file(path, to_bytes("x")).ok());
    }
    EXPECT_TRUE(folder.names().empty());
    EXPECT_FALSE(read_file(folder.path()).ok());
    EXPECT_FALSE(read_file(folder.file("missing")).ok());
}

TEST(File, CheckingLeavesNothingBehindAndTouchesNothing) {
    const TemporaryFolder folder;
    save(folder.file("old.bin"), "old");
    EXPECT_TRUE(check_writable(folder.file("old.bin")).ok());
    EXPECT_TRUE(check_writable(folder.file("new.bin")).ok());
    EXPECT_EQ(folder.names(), std::vector<std::string>{"old.bin"});
    EXPECT_EQ(load_text(folder.file("old.bin")), "old");
}

TEST(File, DevicesAreWrittenInPlaceAndAFullOneIsAnError) {
    EXPECT_TRUE(write_file("/dev/null", to_bytes("x")).ok());
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    EXPECT_FALSE(write_file("/dev/full", to_bytes("x")).ok());
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(File, ExtensionsAreLowerCaseWithoutDot) {
    EXPECT_EQ(extension_of("a/b.c/Bunny.PLY"), "ply");
    EXPECT_EQ(extension_of("a.b/bunny"), "");
    EXPECT_EQ(extension_of(""), "");
}

}  // namespace
}  // namespace gim
