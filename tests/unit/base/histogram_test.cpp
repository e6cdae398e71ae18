#include "common/base/histogram.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace chorus {
namespace {

TEST(Histogram, ThreadsLoseNothing) {
  Histogram values({1.0});
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([&] {
        for (int n = 0; n < 1000; ++n) values.observe(0.5);
      });
  }
  EXPECT_EQ(values.snapshot().counts, (std::vector<std::uint64_t>{4000, 0}));
  EXPECT_DOUBLE_EQ(values.snapshot().sum, 2000.0);
}

}  // namespace
}  // namespace chorus
