#include "common/sensor/shares.h"

#include <gtest/gtest.h>

#include <limits>

namespace chorus {
namespace {

double sum_of(const Shares& shares) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kMaxSensors; ++i) sum += shares.of(i);
  return sum;
}

TEST(Shares, AreInProportionToTheWeights) {
  ShareTally tally;
  tally.add(0b0010, 4e6);
  tally.add(0b1000, 1e6);
  const Shares shares = tally.shares();
  ASSERT_TRUE(shares.known());
  EXPECT_EQ(shares.of(0), 0.0);
  EXPECT_EQ(shares.of(1), 0.8);
  EXPECT_EQ(shares.of(3), 0.2);
}

TEST(Shares, SumToOneHoweverTheyAreRounded) {
  for (std::size_t sensors = 1; sensors <= kMaxSensors; ++sensors) {
    ShareTally tally;
    for (std::size_t i = 0; i < sensors; ++i) tally.add(std::uint64_t{1} << i, 0.37);
    const Shares shares = tally.shares();
    EXPECT_NEAR(sum_of(shares), 1.0, 1e-12) << sensors;
    for (std::size_t i = 0; i < sensors; ++i)
      EXPECT_NEAR(shares.of(i), 1.0 / static_cast<double>(sensors), 0.01) << sensors;
  }
}

TEST(Shares, TwoViewsOfOneSensorAddUp) {
  ShareTally tally;
  tally.add(1, 0.3);
  tally.add(2, 0.4);
  tally.add(1, 0.3);
  EXPECT_EQ(tally.shares().of(0), 0.6);
}

TEST(Shares, WhatIsNoWeightCountsForNothing) {
  ShareTally tally;
  EXPECT_FALSE(tally.shares().known());
  tally.add(0, 1.0);
  tally.add(1, 0.0);
  tally.add(2, -1.0);
  tally.add(4, std::numeric_limits<double>::quiet_NaN());
  tally.add(8, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(tally.shares().known());
  EXPECT_EQ(sum_of(tally.shares()), 0.0);
  tally.add(16, 1e-300);
  EXPECT_EQ(tally.shares().of(4), 1.0);
}

}  // namespace
}  // namespace chorus
