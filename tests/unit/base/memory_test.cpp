// What was freed goes back, whatever was freed before.
#include "common/base/memory.h"

#include <gtest/gtest.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <memory>

namespace chorus {
namespace {

TEST(Memory, ABlockIsLargeHoweverLargeTheOnesBeforeWere) {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "runs with glibc's allocator only: in builds without a sanitizer";
#else
  return_large_blocks();
  constexpr std::size_t kMegabyte = 1 << 20;
  const auto mapped = [] { return ::mallinfo2().hblkhd; };
  { const auto huge = std::make_unique<char[]>(16 * kMegabyte); }
  const std::size_t before = mapped();
  {
    const auto large = std::make_unique<char[]>(kMegabyte);
    EXPECT_GE(mapped(), before + kMegabyte) << "not in a heap";
  }
  EXPECT_EQ(mapped(), before) << "and it went back";
#endif
}

}  // namespace
}  // namespace chorus
