#include "common/http/access.h"

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

RequestHead head_of(std::string_view host, std::string_view origin = {}) {
  RequestHead head;
  head.host = host;
  head.origin = origin;
  return head;
}

const Peer kLocal{true, "127.0.0.1", 8080};
const Peer kRemote{false, "10.0.0.1", 8080};

TEST(SameSecret, OnlyTheSameBytes) {
  EXPECT_TRUE(same_secret("open sesame", "open sesame"));
  EXPECT_TRUE(same_secret("", ""));
  EXPECT_FALSE(same_secret("open sesame", "open sesam"));
  EXPECT_FALSE(same_secret("open sesame", "open sesamf"));
  EXPECT_FALSE(same_secret("", std::string_view("\0", 1)));
}

TEST(TrustedLocal, OwnPagesAndPrograms) {
  EXPECT_TRUE(is_trusted_local(head_of("127.0.0.1:8080"), kLocal));
  EXPECT_TRUE(is_trusted_local(head_of("LocalHost:8080"), kLocal));
  EXPECT_TRUE(is_trusted_local(head_of("[::1]:8080"), kLocal));
  EXPECT_TRUE(is_trusted_local(head_of("localhost:8080", "http://localhost:8080"), kLocal));
  EXPECT_TRUE(is_trusted_local(head_of({}), kLocal)) << "HTTP/1.0";
}

TEST(TrustedLocal, NotOthersThroughABrowserOrAProxy) {
  EXPECT_FALSE(is_trusted_local(head_of("127.0.0.1:8080"), kRemote));
  EXPECT_FALSE(is_trusted_local(head_of("localhost:8080", "http://evil.example"), kLocal));
  EXPECT_FALSE(is_trusted_local(head_of("localhost:8080", "null"), kLocal));
  EXPECT_FALSE(is_trusted_local(head_of("localhost:8080", "http://localhost:81"), kLocal));
  EXPECT_FALSE(is_trusted_local(head_of("evil.example:8080", "http://evil.example:8080"), kLocal))
      << "DNS rebinding";
  EXPECT_FALSE(is_trusted_local(head_of("127.0.0.1.evil.example"), kLocal));
  RequestHead proxied = head_of("127.0.0.1:8080");
  proxied.forwarded = "10.0.0.7";
  EXPECT_FALSE(is_trusted_local(proxied, kLocal));
}

TEST(RefuseWriting, RemoteNeedsTheToken) {
  RequestHead head = head_of("10.0.0.1:8080");
  EXPECT_EQ(refuse_writing(head, kRemote, "")->code, ErrorCode::Forbidden);
  EXPECT_EQ(refuse_writing(head, kRemote, "secret")->code, ErrorCode::Unauthorized);
  for (const auto wrong : {"Bearer wrong", "secret", "Bearer", "Bearer ", "Basic secret", ""}) {
    head.authorization = wrong;
    EXPECT_TRUE(refuse_writing(head, kRemote, "secret")) << wrong;
    EXPECT_TRUE(refuse_writing(head, kRemote, "")) << wrong;
  }
  head.authorization = "BEARER secret";
  EXPECT_FALSE(refuse_writing(head, kRemote, "secret"));
}

TEST(OurAuthority, ThisEndOfTheConnectionOnly) {
  EXPECT_TRUE(is_our_authority("127.0.0.1:8080", kLocal));
  EXPECT_TRUE(is_our_authority("localhost:8080", kLocal));
  EXPECT_FALSE(is_our_authority("localhost:8080", kRemote));
  EXPECT_FALSE(is_our_authority("127.0.0.1", kLocal)) << "port 80";
  EXPECT_FALSE(is_our_authority("127.0.0.1:80801", kLocal));
  EXPECT_FALSE(is_our_authority("evil.example:8080", kLocal));
  EXPECT_FALSE(is_our_authority("[", kLocal));
  EXPECT_FALSE(is_our_authority("", kLocal));
  EXPECT_TRUE(is_our_authority("[::1]:8080", Peer{true, "::1", 8080}));
  EXPECT_TRUE(is_our_authority("127.0.0.1", Peer{true, "127.0.0.1", 80}));
}

}  // namespace
}  // namespace chorus::http
