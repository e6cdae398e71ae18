#include "common/resource/fixed_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

namespace chorus::resource {
namespace {

TEST(FixedPoint, WritesAsManyDecimalsAsAsked) {
  EXPECT_EQ(fixed(1.25, 4), "1.2500");
  EXPECT_EQ(fixed(-0.00006, 4), "-0.0001");
  EXPECT_EQ(fixed(0.0, 5), "0.00000");
  EXPECT_EQ(fixed(1e6, 8), "1000000.00000000");
  EXPECT_EQ(fixed(-1e6, 8)->size(), static_cast<std::size_t>(kMaxFixedLength));
  EXPECT_EQ(fixed(123456789.5, 2), "123456789.50") << "beyond the fast path";
}

TEST(FixedPoint, NeverWritesMinusZero) {
  EXPECT_EQ(fixed(-0.00001, 4), "0.0000");
  EXPECT_EQ(fixed(-0.0, 4), "0.0000");
}

TEST(FixedPoint, LeavesOutWhatHasNoDecimal) {
  EXPECT_EQ(fixed(std::nan(""), 4), std::nullopt);
  EXPECT_EQ(fixed(std::numeric_limits<double>::infinity(), 4), std::nullopt);
  EXPECT_EQ(fixed(1e16, 4), std::nullopt);
}

TEST(FixedPoint, AgreesWithPrintf) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1e4, 1e4);
  for (int i = 0; i < 20'000; ++i) {
    const double value = any(random);
    char text[64];
    std::snprintf(text, sizeof text, "%.4f", value);
    EXPECT_EQ(fixed(value, 4), text);
  }
}

TEST(FixedPoint, WhatItWritesReadsBackWithinHalfAUnit) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-10, 10);
  for (int i = 0; i < 1000; ++i) {
    const double value = any(random);
    EXPECT_NEAR(*read_decimal(*fixed(value, 5)), value, 0.5e-5 + 1e-12);
  }
}

TEST(ParseNumber, TakesTheWholeTextOrNothing) {
  EXPECT_EQ(read_decimal("-1.5e2"), -150.0);
  EXPECT_EQ(read_decimal("+1"), 1.0);
  EXPECT_EQ(read_decimal("1.5x"), std::nullopt);
  EXPECT_EQ(read_decimal(""), std::nullopt);
  EXPECT_EQ(read_decimal("nan"), std::nullopt);
  EXPECT_EQ(read_decimal("INF"), std::nullopt);
  EXPECT_EQ(read_decimal("1e999"), std::nullopt);
  EXPECT_EQ(read_decimal("0x10"), std::nullopt);
}

}  // namespace
}  // namespace chorus::resource
