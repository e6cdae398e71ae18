#include "common/base/shipped_folder.h"

#include <gtest/gtest.h>

namespace chorus {
namespace {

TEST(ShippedFolder, IsFoundBesideTheSourcesByAFileInIt) {
  const auto runner = shipped_folder("pose-runner", "runner.mjs");
  ASSERT_TRUE(runner) << to_string(runner.error());
  EXPECT_TRUE(runner->ends_with("services/pose-runner")) << *runner;
  EXPECT_FALSE(shipped_folder("pose-runner", "index.html")) << "another folder of that name";
  EXPECT_FALSE(shipped_folder("no-such", "runner.mjs"));
}

}  // namespace
}  // namespace chorus
