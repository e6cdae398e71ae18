#include "common/base/median.h"

#include <chrono>

#include <gtest/gtest.h>

namespace chorus {
namespace {

TEST(Median, IsTheValueInTheMiddleOrTheUpperOfTwo) {
  EXPECT_EQ(median(std::vector<double>{3.0}), 3.0);
  EXPECT_EQ(median(std::vector<double>{9.0, 1.0, 5.0}), 5.0);
  EXPECT_EQ(median(std::vector<int>{4, 1, 3, 2}), 3);
  EXPECT_EQ(
      median(std::vector<std::chrono::seconds>{std::chrono::seconds(2), std::chrono::seconds(1)}),
      std::chrono::seconds(2));
}

}  // namespace
}  // namespace chorus
