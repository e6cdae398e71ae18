// UTF-8 according to table 3-7 of Unicode 15: the first and the last byte of every row, and their
// neighbours.
#include "common/rdf/utf8.h"

#include <array>

#include <gtest/gtest.h>

namespace chorus::rdf {
namespace {

using namespace std::string_view_literals;

/// Encodes a character by its number, written without looking at utf8.cpp.
std::string encoded(unsigned code) {
  const auto byte = [](unsigned value) { return static_cast<char>(value); };
  if (code < 0x80) return {byte(code)};
  if (code < 0x800) return {byte(0xC0 | code >> 6), byte(0x80 | (code & 0x3F))};
  if (code < 0x10000) {
    return {byte(0xE0 | code >> 12), byte(0x80 | (code >> 6 & 0x3F)), byte(0x80 | (code & 0x3F))};
  }
  return {byte(0xF0 | code >> 18), byte(0x80 | (code >> 12 & 0x3F)),
          byte(0x80 | (code >> 6 & 0x3F)), byte(0x80 | (code & 0x3F))};
}

TEST(Utf8Length, IsRightForEveryCharacterThereIs) {
  for (unsigned code = 0; code <= 0x110010; ++code) {
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    const bool exists = code <= 0x10FFFF && !surrogate;
    const std::string text = encoded(code);
    ASSERT_EQ(utf8_length(text + "x"), exists ? text.size() : 0U) << std::hex << code;
  }
}

TEST(Utf8Length, RefusesWhatIsLongerThanItNeedBe) {
  EXPECT_EQ(utf8_length("\xC0\x80"sv), 0U);
  EXPECT_EQ(utf8_length("\xC1\xBF"sv), 0U);
  EXPECT_EQ(utf8_length("\xE0\x9F\xBF"sv), 0U);
  EXPECT_EQ(utf8_length("\xE0\xA0\x80"sv), 3U);
  EXPECT_EQ(utf8_length("\xF0\x8F\xBF\xBF"sv), 0U);
  EXPECT_EQ(utf8_length("\xF0\x90\x80\x80"sv), 4U);
}

TEST(Utf8Length, RefusesWhatIsCutOffAtEveryPlace) {
  for (const std::string& whole : {encoded(0xE4), encoded(0x20AC), encoded(0x1F600)}) {
    for (std::size_t kept = 1; kept < whole.size(); ++kept) {
      EXPECT_EQ(utf8_length(whole.substr(0, kept)), 0U);
      EXPECT_EQ(utf8_length(whole.substr(0, kept) + "x"), 0U);
    }
  }
  EXPECT_EQ(utf8_length(""), 0U);
}

TEST(Utf8Length, RefusesAWrongByteInEveryPlace) {
  for (const std::string& whole : {encoded(0xE4), encoded(0x20AC), encoded(0x1F600)}) {
    for (std::size_t at = 1; at < whole.size(); ++at) {
      for (const char wrong : {'\x7F', '\xC0', '\xFF', '\0'}) {
        std::string broken = whole;
        broken[at] = wrong;
        EXPECT_EQ(utf8_length(broken), 0U);
      }
    }
  }
}

TEST(Utf8Length, NoCharacterBeginsWithAContinuationOrAnUnusedByte) {
  for (unsigned first = 0x80; first <= 0xFF; ++first) {
    const bool begins = (first >= 0xC2 && first <= 0xF4);
    const std::string text = std::string(1, static_cast<char>(first)) + "\x90\x90\x90";
    EXPECT_EQ(utf8_length(text) > 0, begins && first != 0xE0 && first != 0xF4) << first;
  }
}

TEST(IsUtf8, LooksAtTheWholeText) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8("Gr\xC3\xBC\xC3\x9F Gott \xE2\x82\xAC"));
  EXPECT_TRUE(is_utf8("a\0b"sv));
  EXPECT_FALSE(is_utf8("fine until here \x80"));
  EXPECT_FALSE(is_utf8("\x80 fine from here"));
}

TEST(CleanUtf8, KeepsWhatIsGoodAndMarksEveryBadByte) {
  EXPECT_EQ(clean_utf8(""), "");
  EXPECT_EQ(clean_utf8("as it is \xF0\x9F\x98\x80"), "as it is \xF0\x9F\x98\x80");
  EXPECT_EQ(clean_utf8("\xE2\x82"), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(clean_utf8("a\xC3(b"), "a\xEF\xBF\xBD(b");
  for (unsigned byte = 0; byte < 256; ++byte) {
    const std::string any{static_cast<char>(byte), 'z', static_cast<char>(255 - byte)};
    EXPECT_TRUE(is_utf8(clean_utf8(any))) << byte;
    EXPECT_EQ(clean_utf8(clean_utf8(any)), clean_utf8(any));
  }
}

}  // namespace
}  // namespace chorus::rdf
