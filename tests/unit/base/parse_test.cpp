#include "common/base/parse.h"

#include <limits>

#include <gtest/gtest.h>

namespace chorus {
namespace {

TEST(ParseNumber, TakesTheWholeTextOrNothing) {
  EXPECT_EQ(parse_number<int>("-12"), -12);
  EXPECT_EQ(parse_number<std::uint64_t>("18446744073709551615"), 18446744073709551615u);
  EXPECT_EQ(parse_number<double>("1.5e3"), 1500.0);
  for (const char* wrong : {"", " 1", "1 ", "+1", "0x1", "1,5", "one", "99999999999"}) {
    EXPECT_FALSE(parse_number<int>(wrong)) << wrong;
  }
  EXPECT_FALSE(parse_number<std::uint64_t>("-1"));
  EXPECT_FALSE(parse_number<std::uint64_t>("18446744073709551616"));
}

TEST(TakeNumber, LeavesWhatIsBehindTheNumber) {
  std::string_view text = "12 34";
  EXPECT_EQ(take_number<int>(text), 12);
  EXPECT_EQ(text, " 34");
  EXPECT_FALSE(take_number<int>(text));
  EXPECT_EQ(text, " 34");
}

TEST(ParseSigned, AllowsOneSignOfPlus) {
  EXPECT_EQ(parse_signed<int>("+7"), 7);
  EXPECT_EQ(parse_signed<int>("-7"), -7);
  EXPECT_EQ(parse_signed<std::int64_t>("-9223372036854775808"),
            std::numeric_limits<std::int64_t>::min());
  for (const char* wrong : {"", " 1", "1 ", "1.0", "0x1", "--1", "++1", "one"}) {
    EXPECT_FALSE(parse_signed<std::int64_t>(wrong)) << wrong;
    EXPECT_FALSE(parse_signed<std::uint64_t>(wrong)) << wrong;
  }
  EXPECT_FALSE(parse_signed<std::uint64_t>("-1"));
}

TEST(ParseFinite, TakesWhatOtherProgramsWrite) {
  EXPECT_EQ(parse_finite("+1.5e2"), 150.0);
  EXPECT_EQ(parse_finite("7.6e-400"), 0.0);
  EXPECT_EQ(parse_finite("-7.6E-400"), 0.0);
  for (const char* wrong : {"", "nan", "inf", "1e999", "-1e999", "1.5x", "7.6e-400x"})
    EXPECT_FALSE(parse_finite(wrong)) << wrong;
}

TEST(ParseNameNumber, OneSpellingForOneNumber) {
  EXPECT_EQ(parse_name_number("0"), 0u);
  EXPECT_EQ(parse_name_number("70"), 70u);
  for (const char* wrong : {"", "00", "070", "-0", "7a"}) EXPECT_FALSE(parse_name_number(wrong));
}

}  // namespace
}  // namespace chorus
