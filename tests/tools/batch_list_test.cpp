#include "tools/batch/batch_list.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <set>

#include "tests/tools/test_files.h"

namespace gim {
namespace {

namespace fs = std::filesystem;
using test::save;
using test::TemporaryFolder;

std::vector<BatchItem> list_of(const std::string& inputs) {
    const Result<std::vector<BatchItem>> items = list_batch(inputs);
    EXPECT_TRUE(items.ok());
    return items.ok() ? items.value() : std::vector<BatchItem>();
}

std::vector<std::string> names_of(const std::vector<BatchItem>& items) {
    std::vector<std::string> names;
    for (const BatchItem& item : items) names.push_back(item.name);
    return names;
}

using Names = std::vector<std::string>;

TEST(BatchList, AFolderGivesItsMeshesBelowIt) {
    const TemporaryFolder folder;
    fs::create_directories(folder.file("b/c"));
    fs::create_directories(folder.file(".hidden"));
    fs::create_directories(folder.file("folder.ply"));
    for (const char* name : {"a.ply", "a.obj", "b/c/d.STL", "b/e.glb", "b/f.gltf", "g.off", "h.txt", "i.png", "j.npz",
                             "k.exr", ".hidden/k.ply", ".l.ply", "folder.ply/m.ply"})
        save(folder.file(name), "");
    const std::vector<BatchItem> items = list_of(folder.path());
    EXPECT_EQ(names_of(items),
              (Names{"a.obj", "a.ply", "b/c/d.STL", "b/e.glb", "b/f.gltf", "folder.ply/m.ply", "g.off", "j.npz"}));
    for (const BatchItem& item : items) EXPECT_TRUE(fs::exists(item.path)) << item.path;
    EXPECT_EQ(names_of(list_of(folder.path() + "/")), names_of(items));
}

TEST(BatchList, AListKeepsPathsAsTheyStand) {
    const TemporaryFolder folder;
    save(folder.file("list"), "# meshes\nb.ply\r\n\n./a.ply\n/data/c d.ply\n../e.ply\nb.ply\nx/../a.ply\nf.npz");
    const std::vector<BatchItem> items = list_of(folder.file("list"));
    EXPECT_EQ(names_of(items), (Names{"a.ply", "b.ply", "data/c d.ply", "e.ply", "f.npz"}));
    EXPECT_EQ(items[2].path, "/data/c d.ply");
    EXPECT_EQ(items[3].path, "../e.ply");
}

TEST(BatchList, NamesAreDifferentThoughPathsAreNot) {
    const TemporaryFolder folder;
    save(folder.file("list"), "../a.ply\n/a.ply\na.ply\na~2.ply\n");
    const std::vector<BatchItem> items = list_of(folder.file("list"));
    const Names names = names_of(items);
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), 4U);
    EXPECT_EQ(names, (Names{"a.ply", "a~2.ply", "a~3.ply", "a~4.ply"}));
    for (const BatchItem& item : items) {
        if (item.name == "a~2.ply") {
            EXPECT_EQ(item.path, "a~2.ply");
        }
    }
}

TEST(BatchList, NamesTheFolderThatCannotBeListed) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may list any folder";
    const TemporaryFolder folder;
    fs::create_directories(folder.file("a/closed"));
    fs::permissions(folder.file("a/closed"), fs::perms::none);
    const Result<std::vector<BatchItem>> items = list_batch(folder.path());
    ASSERT_FALSE(items.ok());
    EXPECT_NE(items.error().message.find("a/closed"), std::string::npos) << items.error().message;
    fs::permissions(folder.file("a/closed"), fs::perms::owner_all);
}

TEST(BatchList, AMeshIsNoList) {
    const TemporaryFolder folder;
    save(folder.file("a.ply"), "ply\n");
    const Result<std::vector<BatchItem>> items = list_batch(folder.file("a.ply"));
    ASSERT_FALSE(items.ok());
    EXPECT_NE(items.error().message.find("no list"), std::string::npos) << items.error().message;
}

TEST(BatchList, TellsWhatIsWrongWithAList) {
    const TemporaryFolder folder;
    save(folder.file("list"), "a.ply\n..\n");
    EXPECT_FALSE(list_batch(folder.file("list")).ok());
    EXPECT_FALSE(list_batch(folder.file("missing")).ok());
}

TEST(BatchList, ShardsAreTheWholeEachItemOnce) {
    std::vector<BatchItem> items;
    for (int i = 0; i < 23; ++i) items.push_back({std::to_string(i), std::to_string(i)});
    for (const uint32_t shards : {1U, 2U, 5U, 23U, 40U}) {
        std::multiset<std::string> found;
        for (uint32_t shard = 1; shard <= shards; ++shard) {
            const std::vector<BatchItem> part = shard_of(items, shard, shards);
            EXPECT_LE(part.size(), (items.size() + shards - 1) / shards);
            for (const BatchItem& item : part) found.insert(item.name);
        }
        EXPECT_EQ(found.size(), items.size());
        EXPECT_EQ(std::set<std::string>(found.begin(), found.end()).size(), items.size());
    }
}

}  // namespace
}  // namespace gim
