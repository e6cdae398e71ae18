#include "common/base/duration.h"

#include <numbers>

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace chorus {
namespace {

TEST(Durations, RoundTripThroughSeconds) {
  for (const std::int64_t ns :
       {0LL, 1LL, -1LL, 33'333'333LL, -33'333'333LL, 86'400'000'000'000LL}) {
    EXPECT_EQ(from_seconds(seconds(Duration(ns))).count(), ns);
  }
}

TEST(Durations, RoundToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(1.6e-9).count(), 2);
  EXPECT_EQ(from_seconds(-1.6e-9).count(), -2);
  EXPECT_EQ(from_seconds(0.4e-9).count(), 0);
}

TEST(Units, ConvertBothWays) {
  EXPECT_DOUBLE_EQ(deg(180), std::numbers::pi);
  EXPECT_DOUBLE_EQ(to_deg(deg(25)), 25);
  EXPECT_DOUBLE_EQ(mm(20), 0.02);
  EXPECT_DOUBLE_EQ(to_mm(mm(20)), 20);
}

}  // namespace
}  // namespace chorus
