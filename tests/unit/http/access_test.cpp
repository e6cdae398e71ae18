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

TEST(TrustedLocal, NotATrustedProxy) {
  Peer proxy = kLocal;
  proxy.proxy = true;
  EXPECT_FALSE(is_trusted_local(head_of("127.0.0.1:8080"), proxy));
}

TEST(OwnHost, AddressesLocalhostAndWhatIsConfigured) {
  const std::vector<std::string> names{"tracker.example", "cell-2"};
  for (const auto ours : {"127.0.0.1:8080", "192.0.2.1", "[::1]:8080", "[fe80::1]", "LOCALHOST:1",
                          "localhost.", "Tracker.Example:8080", "tracker.example.", "cell-2"}) {
    EXPECT_TRUE(is_own_host(ours, names)) << ours;
  }
  for (const auto other : {"evil.example:8080", "tracker.example.evil.example", "x", "", ":8080",
                           "127.0.0.1.evil.example", "localhost.evil.example"}) {
    EXPECT_FALSE(is_own_host(other, names)) << other;
  }
}

TEST(OwnHost, ThisHostHasAName) { EXPECT_TRUE(is_own_host(host_names().at(0), host_names())); }

TEST(OwnPage, SchemeAndHostOfThisService) {
  EXPECT_TRUE(from_own_page(head_of("cell-2:8080", "http://cell-2:8080")));
  EXPECT_TRUE(from_own_page(head_of("cell-2", "https://CELL-2")));
  EXPECT_FALSE(from_own_page(head_of("cell-2:8080", "http://cell-2")));
  EXPECT_FALSE(from_own_page(head_of("cell-2:8080", "ftp://cell-2:8080")));
  EXPECT_FALSE(from_own_page(head_of("cell-2:8080"))) << "no page at all";
}

TEST(RefuseWriting, OnceThereIsATokenLoopbackNeedsItToo) {
  RequestHead head = head_of("127.0.0.1:8080");
  EXPECT_FALSE(refuse_writing(head, kLocal, ""));
  ASSERT_TRUE(refuse_writing(head, kLocal, "secret")) << "it may be a proxy's connection";
  EXPECT_EQ(refuse_writing(head, kLocal, "secret")->code, ErrorCode::Unauthorized);
  head.authorization = "Bearer secret";
  EXPECT_FALSE(refuse_writing(head, kLocal, "secret"));
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
