// Whether a wrong size of a hand is told.
#include "common/hand/size_check.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace chorus::hand {
namespace {

constexpr double kRate = 20.0;

/// A minute at changing distances; the other distance errs by `noise`, alike for a second.
SizeCheck checked(double size, double noise) {
  std::vector<double> by_hand, by_other;
  for (int i = 0; i < 1200; ++i) {
    const double truth = 0.8 + 0.2 * std::sin(i / 50.0);
    by_hand.push_back(truth / size);
    by_other.push_back(truth + noise * std::sin(7.3 * std::floor(i / kRate)));
  }
  return check_size(by_hand, by_other, kRate);
}

TEST(AHandsSize, ThatIsThreePerCentWrongIsToldAndOnePerCentIsNot) {
  EXPECT_TRUE(checked(1.03, 0.02).wrong());
  EXPECT_TRUE(checked(0.97, 0.02).wrong());
  EXPECT_NEAR(checked(1.03, 0.02).factor, 1.03, 0.01);
  EXPECT_FALSE(checked(1.01, 0.02).wrong());
}

/// Twenty ratios, a second apart, as normal as twenty can be; some of them may be wrong altogether.
SizeCheck of_twenty(double size, double sigma, std::size_t wrong = 0) {
  constexpr std::array kNormal{0.063, 0.189, 0.319, 0.454, 0.598,
                               0.755, 0.935, 1.150, 1.440, 1.960};
  std::vector<double> by_hand(20, 1.0), by_other;
  for (const double each : kNormal) {
    by_other.push_back(size + sigma * each);
    by_other.push_back(size - sigma * each);
  }
  for (std::size_t i = 0; i < wrong; ++i) by_other[i] = 1.8;
  return check_size(by_hand, by_other, 1.0);
}

TEST(AHandsSize, IsToldByTwentySecondsThatErrByFourPerCent) {
  EXPECT_TRUE(of_twenty(1.03, 0.04).wrong()) << "a median's error is too large";
  EXPECT_NEAR(of_twenty(1.03, 0.04).sigma, 0.04 / std::sqrt(20.0), 0.001);
}

TEST(AHandsSize, IsNotToldWrongByPicturesWithoutTheHand) {
  EXPECT_FALSE(of_twenty(1.0, 0.01, 2).wrong());
  EXPECT_NEAR(of_twenty(1.0, 0.01, 2).factor, 1.0, 0.005);
}

TEST(AHandsSize, IsNotToldWrongByWhatErrsMore) {
  EXPECT_FALSE(checked(1.03, 0.3).wrong());
  EXPECT_GT(checked(1.03, 0.3).sigma, 0.01);
}

TEST(AHandsSize, OfNothingOrNonsenseIsNotKnown) {
  EXPECT_FALSE(check_size({}, {}, kRate).wrong());
  const std::vector<double> none(50, std::numeric_limits<double>::quiet_NaN()), some(50, 1.0);
  EXPECT_FALSE(check_size(none, some, kRate).wrong());
  EXPECT_EQ(check_size(none, some, kRate).factor, 1.0);
  EXPECT_FALSE(check_size(some, some, 0.0).wrong());
}

}  // namespace
}  // namespace chorus::hand
