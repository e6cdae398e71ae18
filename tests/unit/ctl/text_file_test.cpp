#include "services/ctl/line/text_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using chorus::testing::bytes_of;
using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::TemporaryFolder;
using ::testing::HasSubstr;

TEST(TextFile, NoInputIsEverWritten) {
  const TemporaryFolder folder;
  const std::string walk = (folder / "walk.ndjson").string();
  std::ofstream(walk) << "frames";
  fs::create_symlink(walk, folder / "link.csv");
  EXPECT_THAT(may_write(walk, {walk}), FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(may_write((folder / "link.csv").string(), {"", walk}),
              FailsWith(ErrorCode::InvalidArgument))
      << "by whatever name";
  EXPECT_THAT(may_write(walk, {"-", "http://127.0.0.1:8080/", folder / "other"}), IsOk());
  EXPECT_THAT(may_write((folder / "new.csv").string(), {walk}), IsOk());
}

TEST(TextFile, NoRecordingIsEverOverwritten) {
  const TemporaryFolder folder;
  const std::string walk = (folder / "walk.mcap").string();
  EXPECT_THAT(may_write(walk, {}), IsOk());
  std::ofstream(walk) << "frames";
  const auto refused = may_write(walk, {});
  ASSERT_THAT(refused, FailsWith(ErrorCode::Conflict));
  EXPECT_THAT(to_string(refused.error()), HasSubstr("never overwritten"));
}

TEST(TextFile, WhatCannotBeWrittenLeavesWhatWasThere) {
  const TemporaryFolder folder;
  const std::string file = (folder / "a.csv").string();
  ASSERT_THAT(write_text(file, "old"), IsOk());
  fs::create_directory(folder / "a.csv.partial");  // in the way of the temporary file
  EXPECT_THAT(write_text(file, "new"), FailsWith(ErrorCode::Io));
  EXPECT_EQ(bytes_of(file), "old");
  fs::remove(folder / "a.csv.partial");
  ASSERT_THAT(write_text(file, "new"), IsOk());
  EXPECT_EQ(bytes_of(file), "new");
  const auto nowhere = write_text((folder / "no/such/a.csv").string(), "x");
  ASSERT_THAT(nowhere, FailsWith(ErrorCode::Io));
  EXPECT_THAT(to_string(nowhere.error()), HasSubstr("is its folder there?"));
}

TEST(SameFile, ByWhateverPath) {
  const TemporaryFolder folder;
  const std::string file = folder.write("a.csv", "x").string();
  EXPECT_TRUE(
      same_file(file, (folder / "../").string() + folder.path().filename().string() + "/a.csv"));
  EXPECT_TRUE(same_file((folder / "new").string(), (folder / "./new").string()))
      << "also before it is there";
  EXPECT_FALSE(same_file(file, (folder / "b.csv").string()));
  fs::create_symlink(file, folder / "link");
  EXPECT_TRUE(same_file(file, (folder / "link").string()));
}

TEST(SameFile, StandardOutputIsItselfAndNothingIsNoFile) {
  EXPECT_TRUE(same_file("-", "-"));
  EXPECT_FALSE(same_file("-", "./-")) << "a file of that name";
  EXPECT_FALSE(same_file("", ""));
  EXPECT_FALSE(same_file("", "a"));
}

TEST(MayCreate, OnlyWhatIsNotThere) {
  const TemporaryFolder folder;
  EXPECT_THAT(may_create((folder / "lens.json").string()), IsOk());
  EXPECT_THAT(may_create("-"), IsOk());
  const auto there = may_create(folder.write("lens.json", "{}").string());
  ASSERT_THAT(there, FailsWith(ErrorCode::Conflict));
  EXPECT_THAT(to_string(there.error()), HasSubstr("move it away, or name another --out"));
  EXPECT_THAT(may_create(folder.path().string()), FailsWith(ErrorCode::Conflict)) << "a folder";
}

}  // namespace
}  // namespace chorus::ctl
