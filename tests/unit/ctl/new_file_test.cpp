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

}  // namespace
}  // namespace chorus::ctl
