#include "services/ctl/new_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using fs::perms;

perms mode_of(const fs::path& path) { return fs::status(path).permissions(); }

TEST(MakeFolder, MakesItAndItsParentsForItsReaders) {
  const chorus::testing::TemporaryFolder folder;
  for (const char* name : {"a/own", "b/own/", "c/own//"}) {
    const auto made = folder / name;
    EXPECT_THAT(make_folder(made.string(), Readers::Owner), chorus::testing::IsOk()) << name;
    EXPECT_EQ(mode_of(made), perms::owner_all) << name;
    EXPECT_THAT(make_folder(made.string(), Readers::Owner), chorus::testing::IsOk()) << "again";
  }
}

TEST(MakeFolder, OthersMayPassThroughOneForTheServicesButNotLookAround) {
  const chorus::testing::TemporaryFolder folder;
  const auto made = folder / "tls/";
  ASSERT_THAT(make_folder(made.string(), Readers::Services), chorus::testing::IsOk());
  EXPECT_EQ(mode_of(made),
            perms::owner_all | perms::group_read | perms::group_exec | perms::others_exec);
}

}  // namespace
}  // namespace chorus::ctl
