#include "common/synthetic/draw.h"

#include <gtest/gtest.h>

#include <set>

namespace chorus::synthetic {
namespace {

TEST(Draw, SameKeySameNumbersOtherKeyOtherNumbers) {
  EXPECT_EQ((Draw{1, 2, 3}.bits()), (Draw{1, 2, 3}.bits()));
  std::set<std::uint64_t> seen;
  for (std::uint64_t a = 0; a < 30; ++a) {
    for (std::uint64_t b = 0; b < 30; ++b) seen.insert(Draw{a, b}.bits());
  }
  EXPECT_EQ(seen.size(), 900u) << "neighbouring keys, and swapped ones, do not collide";
}

TEST(Draw, GaussHasUnitMomentsOverSuccessiveKeys) {
  constexpr int kCount = 100'000;
  double sum = 0, square = 0, fourth = 0, product = 0, before = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const double x = Draw{7, i}.gauss();
    sum += x;
    square += x * x;
    fourth += x * x * x * x;
    product += x * before;
    before = x;
  }
  // The standard errors are 1, sqrt(2), sqrt(96) and 1, each divided by sqrt(100 000); five of them
  // are allowed.
  EXPECT_NEAR(sum / kCount, 0.0, 0.016);
  EXPECT_NEAR(square / kCount, 1.0, 0.023);
  EXPECT_NEAR(fourth / kCount, 3.0, 0.16);
  EXPECT_NEAR(product / kCount, 0.0, 0.016);
}

TEST(Draw, UniformStaysInItsInterval) {
  Draw draw{3};
  double least = 1, most = 0;
  for (int i = 0; i < 10'000; ++i) {
    const double x = draw.uniform();
    least = std::min(least, x);
    most = std::max(most, x);
  }
  EXPECT_GE(least, 0.0);
  EXPECT_LT(most, 1.0);
  EXPECT_LT(least, 0.01);
  EXPECT_GT(most, 0.99);
}

}  // namespace
}  // namespace chorus::synthetic
