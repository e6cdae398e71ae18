#include "common/resource/fixed_point.h"
#include "common/resource/decimal_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>
#include <string>

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

/// Reads a number with four decimals from `text`, which is followed by the rest of a document.
std::optional<double> short_fixed(const std::string& text) {
  const std::string document = text + " ;\n  ch:y 1.0";
  double value = 0.0;
  const char* const end = document.data() + document.size();
  const char* const next = read_short_fixed<4>(document.data(), end, value);
  if (next == nullptr) return std::nullopt;
  EXPECT_EQ(next, document.data() + text.size()) << text;
  return value;
}

TEST(ReadShortFixed, GivesTheDoubleThatParsingGives) {
  for (int units = -99'999; units <= 99'999; units += 7) {
    const std::string text = *fixed(units / 1e4, 4);
    EXPECT_EQ(short_fixed(text), read_decimal(text)) << text;
  }
  EXPECT_TRUE(std::signbit(*short_fixed("-0.0000")));
}

TEST(ReadShortFixed, LeavesEveryOtherSpellingToTheParser) {
  for (const char* const text :
       {"12.3456", "1.23456", "1.234", ".1234", "1,2345", "1.23:5", "1.2/45", "+1.2345", "--1.2345",
        "1.\xB1\xB2\xB3\xB4", "x.1234", "/.1234"})
    EXPECT_EQ(short_fixed(text), std::nullopt) << text;
}

TEST(ReadShortFixed, ReadsNothingBehindTheText) {
  const std::string text = "1.23456789 ;\n";
  double value = 0.0;
  EXPECT_EQ(read_short_fixed<8>(text.data(), text.data() + 12, value), text.data() + 10);
  EXPECT_EQ(read_short_fixed<8>(text.data(), text.data() + 11, value), nullptr);
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
