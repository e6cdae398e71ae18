#include <gtest/gtest.h>

#include "common/http/client.h"

namespace chorus::http {
namespace {

void expect_url(std::string_view text, const Url& expected) {
  const auto url = parse_url(text);
  ASSERT_TRUE(url) << text;
  EXPECT_EQ(url->host, expected.host) << text;
  EXPECT_EQ(url->port, expected.port) << text;
  EXPECT_EQ(url->target, expected.target) << text;
}

TEST(ParseUrl, HostPortTarget) {
  expect_url("http://a", {"a", 80, "/"});
  expect_url("HTTP://a.b:8081/frame?at=1#x", {"a.b", 8081, "/frame?at=1"});
  expect_url("http://a?q", {"a", 80, "/?q"});
  expect_url("http://[::1]:80/x", {"::1", 80, "/x"});
  expect_url("http://127.0.0.1:65535", {"127.0.0.1", 65535, "/"});
}

TEST(ParseUrl, RefusesEverythingElse) {
  for (const auto text : {"", "a", "https://a/", "http://", "http:///x", "http://a:0/",
                          "http://a:x", "http://a:70000", "http://u:p@a/", "http://u@a/",
                          "http://a b/", "http://a/\r\n", "ftp://a", "http://[::1/", "http://:80/"})
    EXPECT_FALSE(parse_url(text)) << text;
}

}  // namespace
}  // namespace chorus::http
