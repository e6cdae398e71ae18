#include "common/http/admission.h"

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

std::optional<std::string> forwarded(std::string_view lines) {
  static RequestHead head;
  static std::string bytes;
  bytes = "GET / HTTP/1.1\r\nHost: a\r\n" + std::string(lines) + "\r\n";
  EXPECT_FALSE(read_head(bytes, head));
  return forwarded_account(head);
}

TEST(ForwardedAccount, IsWhatTheLastProxyHasSeen) {
  EXPECT_EQ(forwarded("X-Forwarded-For: 192.0.2.7\r\n"), "192.0.2.7");
  EXPECT_EQ(forwarded("X-Forwarded-For: 203.0.113.1, 192.0.2.7\r\n"), "192.0.2.7");
  EXPECT_EQ(forwarded("x-forwarded-for: 203.0.113.1\r\nX-Forwarded-For: 192.0.2.7\r\n"),
            "192.0.2.7");
  EXPECT_EQ(forwarded("X-Forwarded-For: 192.0.2.7, unknown\r\n"), std::nullopt);
  EXPECT_EQ(forwarded("Via: 1.1 192.0.2.7\r\n"), std::nullopt);
}

}  // namespace
}  // namespace chorus::http
