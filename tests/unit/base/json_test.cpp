#include "common/base/json.h"

#include <string>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace chorus {
namespace {

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(ParseJson, GivesWhatTheParserGives) {
  const auto json = parse_json(R"({"a": [1, 2.5, "x", null, true], "b": {"a": 1}})");
  ASSERT_TRUE(json) << to_string(json.error());
  EXPECT_EQ(json->at("a").size(), 5U);
  EXPECT_EQ(json->at("b").at("a"), 1) << "the same key in another object is no repetition";
  EXPECT_EQ(parse_json("17").value(), 17);
}

TEST(ParseJson, NamesAKeyThatAnObjectHasTwice) {
  for (const char* text : {R"({"a": 1, "a": 1})", R"([{"b": 1}, {"a": 1, "b": {"c": 2}, "a": 2}])",
                           R"({"x": {"a": 1, "a": 2}})"}) {
    const auto json = parse_json(text);
    ASSERT_FALSE(json) << text;
    EXPECT_EQ(json.error().context, "a") << text;
    EXPECT_EQ(json.error().code, ErrorCode::Malformed);
  }
  const auto longest =
      parse_json("{\"" + std::string(500, 'k') + "\":1,\"" + std::string(500, 'k') + "\":1}");
  ASSERT_FALSE(longest);
  EXPECT_EQ(longest.error().context.size(), 80U);
}

TEST(ParseJson, QuotesLittleOfWhatItCannotRead) {
  const std::string endless = R"({"a": "; expected ')" + std::string(100'000, 'x');
  for (const std::string& text : {endless, endless + "\"", endless + "\" 1"}) {
    const auto json = parse_json(text);
    ASSERT_FALSE(json);
    EXPECT_LT(json.error().message.size(), 300U) << json.error().message.substr(0, 300);
    EXPECT_NE(json.error().message.find("line 1"), std::string::npos);
  }
}

TEST(ParseJson, SaysInPlainWordsWhatIsWrongAndWhere) {
  const std::pair<const char*, const char*> cases[]{
      {"", "is empty"},
      {" \n", "is empty"},
      {"[1, tru]", "line 1, column 8: this is no JSON: tru"},
      {"{\n \"x\": NaN\n}", "line 2, column 7: NaN and Infinity are no numbers in JSON"},
      {"[-Infinity]", "NaN and Infinity are no numbers in JSON"},
      {"{\"x\": 1,\n", "line 2, column 1: the JSON ends too early"},
      {"[1\n 2]", "line 2, column 2: this is no JSON: 2"},
      {"{'a': 1}", "JSON quotes texts with \", not with '"},
      {"\"\xFF\"", "not in UTF-8"},
      {"1e999", "a number in it is too large"}};
  for (const auto& [text, words] : cases) {
    const auto json = parse_json(text);
    ASSERT_FALSE(json) << text;
    EXPECT_NE(json.error().message.find(words), std::string::npos)
        << text << ": " << json.error().message;
    EXPECT_EQ(json.error().message.find("parse"), std::string::npos);
  }
  const auto secret = parse_json("{\"token\": hidden}", {.comments = true});
  ASSERT_FALSE(secret);
  EXPECT_EQ(secret.error().message.find("hid"), std::string::npos) << secret.error().message;
}

TEST(ParseJson, CountsDepthAsABracketCounterWould) {
  EXPECT_TRUE(parse_json(repeated("[", 32) + repeated("]", 32)));
  const auto deep = parse_json(repeated("[", 33) + repeated("]", 33));
  ASSERT_FALSE(deep);
  EXPECT_EQ(deep.error().code, ErrorCode::TooLarge);
  EXPECT_FALSE(parse_json(repeated("{\"a\":", 33) + "1" + repeated("}", 33)));
  EXPECT_TRUE(parse_json("[" + repeated("[],{},", 1000) + "1]")) << "side by side is not deep";
  EXPECT_FALSE(parse_json(repeated("[", 100'000))) << "no recursion into it";
}

TEST(ParseJson, BracketsInTextsAreNoDepth) {
  const std::string many = repeated("[{", 100);
  EXPECT_TRUE(parse_json("{\"a\": \"" + many + "\"}"));
  EXPECT_TRUE(parse_json("{\"" + many + "\": 1}"));
  EXPECT_TRUE(parse_json("[\"\\\"" + many + "\"]")) << "an escaped quote ends no text";
  EXPECT_FALSE(parse_json("[\"\\\\\"," + many)) << "an escaped backslash escapes nothing";
}

TEST(ParseJson, LimitsAreTheCallers) {
  const JsonLimits narrow{.bytes = 10, .nesting = 2};
  EXPECT_TRUE(parse_json("[[1,2,3]]", narrow));
  EXPECT_FALSE(parse_json("[[[1]]]", narrow));
  const auto longer = parse_json("[1,2,3,4,5]", narrow);
  ASSERT_FALSE(longer);
  EXPECT_NE(longer.error().message.find("at most 10"), std::string::npos);
}

TEST(ParseJson, BrokenTextsAreErrorsThatNameTheByte) {
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[1,]"), std::string("{\"a\" 1}"),
        std::string("\"\xFF\""), std::string("nul"), std::string("1 2"), std::string("[1\0]", 4),
        std::string("NaN"), std::string("1e999"), std::string("{'a': 1}")}) {
    const auto json = parse_json(text);
    ASSERT_FALSE(json) << text;
    EXPECT_EQ(json.error().code, ErrorCode::Malformed) << text;
    EXPECT_FALSE(json.error().message.empty());
  }
}

}  // namespace
}  // namespace chorus
