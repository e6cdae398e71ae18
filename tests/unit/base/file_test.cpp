#include "common/base/file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <thread>

#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus {
namespace {

namespace fs = std::filesystem;
using chorus::testing::bytes_of;
using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::TemporaryFolder;

TEST(File, IsReadWholeWithinItsBound) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << std::string(200'000, 'x');
  EXPECT_EQ(read_file(folder / "a", 200'000).value().size(), 200'000u);
  EXPECT_THAT(read_file(folder / "a", 199'999), FailsWith(ErrorCode::TooLarge));
  EXPECT_THAT(read_file(folder / "none", 10), FailsWith(ErrorCode::NotFound));
  EXPECT_THAT(read_file(folder / "", 10), FailsWith(ErrorCode::Io));
  std::ofstream(folder / "empty") << "";
  EXPECT_EQ(read_file(folder / "empty", 0).value(), "");
}

TEST(File, IsReplacedAtOnceAndKeepsItsRightsAndItsLinks) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "old";
  fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink(folder / "a", folder / "link");
  ASSERT_THAT(replace_file(folder / "link", "new"), IsOk());
  EXPECT_EQ(bytes_of(folder / "a"), "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_FALSE(fs::exists(folder / "a.partial"));
}

TEST(File, ThatCannotBeReplacedStaysAsItWas) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "old";
  fs::create_directory(folder / "a.partial");
  EXPECT_THAT(replace_file(folder / "a", "new"), FailsWith(ErrorCode::Io));
  EXPECT_EQ(bytes_of(folder / "a"), "old");
  EXPECT_THAT(replace_file(folder / "no/such", "new"), FailsWith(ErrorCode::Io));
}

TEST(File, APipeIsNoFileAndNobodyWaitsForIt) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  const auto read = read_file(folder / "pipe", 10);
  ASSERT_THAT(read, FailsWith(ErrorCode::Io));
  EXPECT_THAT(read.error().message, ::testing::HasSubstr("a file is wanted"));
  EXPECT_THAT(read_file("/dev/null", 10), FailsWith(ErrorCode::Io));
  EXPECT_THAT(replace_file(folder / "pipe", "text"), FailsWith(ErrorCode::Io)) << "nobody reads it";
}

TEST(File, APipeThatAPersonNamedIsReadToItsEnd) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(folder / "pipe") << std::string(200'000, 'x'); });
  EXPECT_EQ(read_file_or_pipe(folder / "pipe", 1 << 20).value_or("").size(), 200'000u);
  writer.join();
  EXPECT_THAT(read_file_or_pipe(folder / "", 10), FailsWith(ErrorCode::Io));
  EXPECT_EQ(read_file_or_pipe("/dev/null", 10).value_or("?"), "");
}

TEST(File, ALinkToItselfIsThereAndIsTold) {
  const TemporaryFolder folder;
  fs::create_symlink(folder / "self", folder / "self");
  EXPECT_TRUE(is_there(folder / "self"));
  EXPECT_FALSE(is_there(folder / "none"));
  const auto read = read_file(folder / "self", 10);
  ASSERT_THAT(read, FailsWith(ErrorCode::Io));
  EXPECT_THAT(read.error().message, ::testing::HasSubstr("leads back to itself"));
}

TEST(File, DevicesAreWrittenToAndNotReplaced) {
  ASSERT_THAT(replace_file("/dev/null", "gone"), IsOk());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace chorus
