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
  EXPECT_EQ(url->secure, expected.secure) << text;
}

TEST(ParseUrl, HostPortTarget) {
  expect_url("http://a", {"a", 80, "/"});
  expect_url("HTTP://a.b:8081/frame?at=1#x", {"a.b", 8081, "/frame?at=1"});
  expect_url("http://a?q", {"a", 80, "/?q"});
  expect_url("http://[::1]:80/x", {"::1", 80, "/x"});
  expect_url("http://127.0.0.1:65535", {"127.0.0.1", 65535, "/"});
  expect_url("https://a/b", {"a", 443, "/b", true});
  expect_url("HTTPS://a:8081", {"a", 8081, "/", true});
}

TEST(UrlText, IsReadAsTheSame) {
  for (const char* const text : {"http://a:80/b?c", "https://[::1]:443/", "https://a:8081/x"}) {
    const Url url = parse_url(text).value();
    EXPECT_EQ(url_text(url, url.target), text);
  }
}

TEST(ParseUrl, RefusesEverythingElse) {
  for (const auto text : {"", "a", "https://", "http://", "http:///x", "http://a:0/", "http://a:x",
                          "http://a:70000", "http://u:p@a/", "http://u@a/", "http://a b/",
                          "http://a/\r\n", "ftp://a", "http://[::1/", "http://:80/"})
    EXPECT_FALSE(parse_url(text)) << text;
}

}  // namespace
}  // namespace chorus::http
