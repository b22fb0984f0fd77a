#include "daemon/file_system.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/thind_site.h"

namespace thind {
namespace {

using thin::test::content_of;
using thin::test::write_content;

class FileSystemTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  thin::test::TemporaryFolder folder_;
};

TEST_F(FileSystemTest, HashesAsThePublishedVectorsSay) {
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  const std::string million(1'000'000, 'a');
  write_content(path("a"), million);
  EXPECT_EQ(*sha256_of_file(path("a")), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(*sha256_of_beginning(path("a"), 0), sha256_of(""));
  EXPECT_EQ(*sha256_of_beginning(path("a"), 300'000), sha256_of(million.substr(0, 300'000)));
  EXPECT_EQ(*sha256_of_beginning(path("a"), 2'000'000), sha256_of(million));
}

TEST_F(FileSystemTest, NeverFollowsALinkNorWaitsForAPipe) {
  write_content(path("a"), "text");
  std::filesystem::create_symlink(path("a"), path("link"));
  EXPECT_FALSE(sha256_of_file(path("link")));
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_EQ(*sha256_of_file(path("pipe")), sha256_of(""));
}

TEST_F(FileSystemTest, MovesOnlyToFreeNames) {
  write_content(path("a"), "a");
  write_content(path("b"), "b");
  EXPECT_FALSE(*move_to_free(path("a"), path("b")));
  EXPECT_EQ(content_of(path("b")), "b");
  EXPECT_TRUE(*move_to_free(path("a"), path("c")));
  EXPECT_FALSE(exists(path("a")));
  EXPECT_FALSE(move_to_free(path("a"), path("d")));
}

TEST_F(FileSystemTest, MovesAcrossFileSystems) {
  struct stat here {
  }, memory{};
  ASSERT_EQ(::stat(folder_.path().c_str(), &here), 0);
  if (::stat("/dev/shm", &memory) != 0 || here.st_dev == memory.st_dev) GTEST_SKIP() << "one file system only";
  std::string pattern = "/dev/shm/thind-test-XXXXXX";
  const std::string other = ::mkdtemp(pattern.data());
  write_content(path("a"), "content");
  EXPECT_TRUE(*move_to_free(path("a"), other + "/a"));
  EXPECT_FALSE(exists(path("a")));
  EXPECT_EQ(content_of(other + "/a"), "content");
  write_content(path("a"), "second");
  EXPECT_FALSE(*move_to_free(path("a"), other + "/a"));
  EXPECT_EQ(content_of(path("a")), "second");
  EXPECT_EQ(list_folder(other)->size(), 1U) << "no temporary file stays";
  std::filesystem::remove_all(other);
}

TEST_F(FileSystemTest, PlacingIsRepeatable) {
  std::filesystem::create_directory(path("archive"));
  const std::string hash = sha256_of("content");
  write_content(path("spooled"), "content");
  EXPECT_EQ(*place_file(path("spooled"), path("archive"), "x.bufr", hash), path("archive/x.bufr"));
  EXPECT_EQ(*place_file(path("spooled"), path("archive"), "x.bufr", hash), path("archive/x.bufr"));
  write_content(path("spooled"), "content");
  EXPECT_EQ(*place_file(path("spooled"), path("archive"), "x.bufr", hash), path("archive/x.bufr"));
  EXPECT_FALSE(exists(path("spooled"))) << "it is there already";
}

TEST_F(FileSystemTest, PlacingKeepsOtherContentOfTheName) {
  std::filesystem::create_directory(path("archive"));
  write_content(path("archive/x.bufr"), "other");
  write_content(path("spooled"), "content");
  const std::string hash = sha256_of("content");
  const std::string expected = path("archive/x-" + hash.substr(0, 8) + ".bufr");
  EXPECT_EQ(*place_file(path("spooled"), path("archive"), "x.bufr", hash), expected);
  EXPECT_EQ(content_of(path("archive/x.bufr")), "other");
  EXPECT_EQ(*place_file(path("spooled"), path("archive"), "x.bufr", hash), expected) << "found again after a crash";
}

TEST_F(FileSystemTest, PlacingSaysWhereNothingIs) {
  const auto placed = place_file(path("nowhere"), folder_.path().string(), "x", sha256_of("content"));
  ASSERT_FALSE(placed);
  EXPECT_EQ(placed.error().kind, ErrorKind::input);
}

TEST_F(FileSystemTest, ComparesTrees) {
  for (const char* tree : {"one", "two"}) {
    std::filesystem::create_directories(path(tree) + "/deep");
    write_content(path(tree) + "/a", "a");
    write_content(path(tree) + "/deep/b", "b");
  }
  EXPECT_TRUE(*same_content(path("one"), path("two")));
  write_content(path("two/deep/b"), "c");
  EXPECT_FALSE(*same_content(path("one"), path("two")));
  write_content(path("two/deep/b"), "b");
  write_content(path("two/more"), "");
  EXPECT_FALSE(*same_content(path("one"), path("two")));
  EXPECT_FALSE(*same_content(path("one"), path("one/a")));
}

TEST_F(FileSystemTest, WritesWholeFiles) {
  ASSERT_TRUE(write_file(path("a"), "first"));
  ASSERT_TRUE(write_file(path("a"), "second"));
  EXPECT_EQ(*read_file(path("a")), "second");
  EXPECT_EQ(list_folder(folder_.path().string())->size(), 1U);
  EXPECT_FALSE(write_file(path("no/such/folder"), "x"));
}

TEST_F(FileSystemTest, NamesStayNames) {
  const std::string hash = sha256_of("x");
  EXPECT_EQ(with_hash("a.tar.gz", hash), "a.tar-" + hash.substr(0, 8) + ".gz");
  EXPECT_EQ(with_hash("a", hash), "a-" + hash.substr(0, 8));
  EXPECT_LE(with_hash(std::string(255, 'n'), hash).size(), 240U);
  EXPECT_LE(with_hash("n." + std::string(253, 'x'), hash).size(), 240U);
  EXPECT_EQ(plain_name("AMSUA.bufr", hash), "AMSUA.bufr");
  EXPECT_EQ(plain_name("a\nb\xff.bufr", hash), "a_b_-" + hash.substr(0, 8) + ".bufr");
  EXPECT_LE(plain_name(std::string(255, 'n'), hash).size(), 240U);
}

}  // namespace
}  // namespace thind
