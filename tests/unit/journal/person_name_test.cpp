#include "fusion-server/journal/person_name.h"

#include <gtest/gtest.h>

namespace chorus::journal {
namespace {

std::string refusal(std::string_view text) {
  const auto name = checked_name(text);
  return name ? std::string() : name.error().message;
}

TEST(PersonName, MayBeWrittenInAnyAlphabet) {
  for (const char* name : {"Anna", "Anna-Lena O'Neil", "Łukasz", "李小龍", "Zoë 😀", "<b>&"}) {
    const auto checked = checked_name(name);
    ASSERT_TRUE(checked) << name;
    EXPECT_EQ(*checked, name);
  }
  EXPECT_EQ(checked_name("  Anna  ").value_or("?"), "Anna");
  EXPECT_EQ(checked_name("").value_or("?"), "");
  EXPECT_EQ(checked_name("   ").value_or("?"), "");
}

TEST(PersonName, HasAtMostFortyCharactersHoweverManyBytes) {
  std::string forty;
  for (int i = 0; i < 40; ++i) forty += "ł";
  EXPECT_EQ(refusal(forty), "");
  EXPECT_NE(refusal(forty + "x"), "");
  EXPECT_NE(refusal(std::string(300, 'a')), "");
}

TEST(PersonName, HasNothingThatIsNoLetterOfAName) {
  const std::string_view nul("a\0b", 3);
  for (const std::string_view bad :
       {nul, std::string_view("a\nb"), std::string_view("a\tb"), std::string_view("a\x7f"),
        std::string_view("a/b"), std::string_view("..\\b"), std::string_view("a\xc2\x85"),
        std::string_view("a\xe2\x80\xae"
                         "b"),
        std::string_view("\xe2\x80\x8b"),
        std::string_view("\xef\xbb\xbf"
                         "a")})
    EXPECT_NE(refusal(bad), "") << bad;
}

TEST(PersonName, IsUtf8) {
  for (const char* bad : {"\x80", "a\xc3", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80",
                          "\xf5\x80\x80\x80", "\xf4\x90\x80\x80", "\xff"})
    EXPECT_EQ(refusal(bad), "the name is not UTF-8") << bad;
}

}  // namespace
}  // namespace chorus::journal
