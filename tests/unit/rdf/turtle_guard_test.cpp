#include "common/rdf/turtle_guard.h"

#include <gtest/gtest.h>

#include <string>

namespace chorus::rdf {
namespace {

std::string repeated(std::string_view text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(TurtleGuard, CountsOpenBracketsNotAllBrackets) {
  EXPECT_TRUE(check_bytes(repeated("<a> <b> [ ] .\n", 1000)));
  EXPECT_TRUE(check_bytes("<a> <b> " + repeated("[ <b> ", 32) + repeated("]", 32) + " ."));
  EXPECT_FALSE(check_bytes("<a> <b> " + repeated("[ <b> ", 33)));
}

TEST(TurtleGuard, TwentyThousandNestedBracketsAreTooMuch) {
  const auto refused = check_bytes("<a> <b> " + repeated("[ <b> ", 20'000));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::TooLarge);
  EXPECT_FALSE(check_bytes("<a> <b> " + repeated("(", 20'000)));
}

TEST(TurtleGuard, BracketsInStringsIrisAndCommentsDoNotCount) {
  const std::string many = repeated("[(", 100);
  EXPECT_TRUE(check_bytes("<a> <b> \"" + many + "\" ."));
  EXPECT_TRUE(check_bytes("<a> <b> '''" + many + "\n'' ''' ."));
  EXPECT_TRUE(check_bytes("<a> <b#" + many + "> 1 ."));
  EXPECT_TRUE(check_bytes("# " + many + "\n<a> <b> \"\\\"" + many + "\" ."));
}

TEST(TurtleGuard, NothingHidesBracketsFromIt) {
  const std::string many = repeated("[", 100);
  EXPECT_FALSE(check_bytes("# it's a comment\r" + many));
  EXPECT_FALSE(check_bytes("\"\"\"a\"\"\"\"" + many)) << "four quotes close a long string";
  EXPECT_FALSE(check_bytes("( \"\"\"a\"\"\"\"\"\"b\"\"\" " + many))
      << "two strings stand side by side";
  EXPECT_FALSE(check_bytes("\"\"\"a\"\\\"\"\" , " + many + " \"\"\""))
      << "Serd 0.30 closes it early";
  EXPECT_FALSE(check_bytes("\"\"" + many)) << "an empty string is closed";
  EXPECT_FALSE(check_bytes("'a\\\\'" + many)) << "an escaped backslash escapes nothing";
  EXPECT_FALSE(check_bytes("<a\n" + many)) << "an IRI ends with its line";
  EXPECT_FALSE(check_bytes("\"a\n" + many)) << "so does a short string";
}

TEST(TurtleGuard, NamesTheLine) {
  const auto refused = check_bytes("<a> <b> 1 .\n\n<a> <b c> 1 .\n");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().context, "line 3");
}

TEST(TurtleGuard, RefusesWhatIsTooLongOrCutOff) {
  EXPECT_EQ(check_bytes(std::string(2'000'001, ' ')).error().code, ErrorCode::TooLarge);
  EXPECT_TRUE(check_bytes(std::string(2'000'000, ' ')));
  EXPECT_FALSE(check_bytes("<a> <b> \"abc"));
  EXPECT_FALSE(check_bytes("<a> <b> '''abc''"));
  EXPECT_FALSE(check_bytes("<a> <b"));
  EXPECT_FALSE(check_bytes(std::string_view("<a> <b> 1 .\0", 12)));
  EXPECT_TRUE(check_bytes(""));
  EXPECT_TRUE(check_bytes("\\"));
}

}  // namespace
}  // namespace chorus::rdf
