#include "tests/bench/live/scratch_folder.h"

#include <fstream>
#include <utility>

#include <gtest/gtest.h>

namespace chorus::bench {
namespace {

TEST(ScratchFolder, IsThereWhileSomebodyHoldsIt) {
  std::filesystem::path path;
  {
    auto made = ScratchFolder::make();
    ASSERT_TRUE(made);
    path = made->path();
    std::ofstream(path / "file") << "content";
    const ScratchFolder held = std::move(*made);
    EXPECT_EQ(held.path(), path);
    EXPECT_TRUE(std::filesystem::exists(path / "file"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(ScratchFolder, IsAnotherOneEachTime) {
  const auto one = ScratchFolder::make();
  const auto other = ScratchFolder::make();
  ASSERT_TRUE(one && other);
  EXPECT_NE(one->path(), other->path());
}

}  // namespace
}  // namespace chorus::bench
