#include "common/http/uri.h"

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

std::string decoded(std::string_view raw) {
  std::string storage;
  const auto path = decode_path(raw, storage);
  return path ? std::string(*path) : "refused";
}

TEST(Path, DecodesEscapes) {
  EXPECT_EQ(decoded("/frames/42"), "/frames/42");
  EXPECT_EQ(decoded("/a%20b/%C3%A4"), "/a b/\xC3\xA4");
  EXPECT_EQ(decoded("/%7Bname%7d"), "/{name}");
}

TEST(Path, RefusesBrokenEscapes) {
  for (const auto raw : {"/%", "/%4", "/%zz", "/%4g", "/a%"}) EXPECT_EQ(decoded(raw), "refused");
}

TEST(Path, RefusesEscapedControlAndSeparators) {
  for (const auto raw : {"/%00", "/a%0d%0a", "/%7f", "/a%2Fb", "/a%5cb"})
    EXPECT_EQ(decoded(raw), "refused") << raw;
}

TEST(Path, RefusesDotSegmentsInEverySpelling) {
  for (const auto raw : {"/..", "/../x", "/a/../b", "/a/%2e%2e/b", "/.%2E", "/./x", "/a/."})
    EXPECT_EQ(decoded(raw), "refused") << raw;
  EXPECT_EQ(decoded("/.well-known/void"), "/.well-known/void");
  EXPECT_EQ(decoded("/a..b/...c"), "/a..b/...c");
}

TEST(Query, DecodesPairs) {
  const Query expected{{"a", "1"}, {"b", " &="}, {"empty", ""}, {"key", ""}, {"t", "+01:00"}};
  EXPECT_EQ(*decode_query("a=0&a=1&b=%20%26%3D&&empty=&key&t=+01:00"), expected);
  EXPECT_TRUE(decode_query("")->empty());
}

TEST(Query, RefusesBrokenEscapes) {
  EXPECT_FALSE(decode_query("a=%"));
  EXPECT_FALSE(decode_query("%00=1"));
}

}  // namespace
}  // namespace chorus::http
