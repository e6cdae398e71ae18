#include "common/base/parse.h"

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

TEST(ParseNameNumber, OneSpellingForOneNumber) {
  EXPECT_EQ(parse_name_number("0"), 0u);
  EXPECT_EQ(parse_name_number("70"), 70u);
  for (const char* wrong : {"", "00", "070", "-0", "7a"}) EXPECT_FALSE(parse_name_number(wrong));
}

}  // namespace
}  // namespace chorus
