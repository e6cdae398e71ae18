#include "common/http/access.h"

#include <gtest/gtest.h>

#include <array>

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

const Guard kNoToken{};
const Guard kOneToken{{{"secret", Role::Control}}, false};

std::optional<Error> refuse_writing(const RequestHead& head, const Peer& peer, const Guard& guard) {
  return refuse_access(head, peer, Role::Control, guard);
}

TEST(RefuseWriting, OnceThereIsATokenLoopbackNeedsItToo) {
  RequestHead head = head_of("127.0.0.1:8080");
  EXPECT_FALSE(refuse_writing(head, kLocal, kNoToken));
  ASSERT_TRUE(refuse_writing(head, kLocal, kOneToken)) << "it may be a proxy's connection";
  EXPECT_EQ(refuse_writing(head, kLocal, kOneToken)->code, ErrorCode::Unauthorized);
  head.authorization = "Bearer secret";
  EXPECT_FALSE(refuse_writing(head, kLocal, kOneToken));
}

TEST(RefuseWriting, RemoteNeedsTheToken) {
  RequestHead head = head_of("10.0.0.1:8080");
  EXPECT_EQ(refuse_writing(head, kRemote, kNoToken)->code, ErrorCode::Forbidden);
  EXPECT_EQ(refuse_writing(head, kRemote, kOneToken)->code, ErrorCode::Unauthorized);
  for (const auto wrong : {"Bearer wrong", "secret", "Bearer", "Bearer ", "Basic secret", ""}) {
    head.authorization = wrong;
    EXPECT_TRUE(refuse_writing(head, kRemote, kOneToken)) << wrong;
    EXPECT_TRUE(refuse_writing(head, kRemote, kNoToken)) << wrong;
  }
  head.authorization = "Bearer wrong";
  EXPECT_NE(refuse_writing(head, kRemote, kOneToken)->message.find("is none of this service"),
            std::string::npos);
  head.authorization = {};
  EXPECT_NE(refuse_writing(head, kRemote, kOneToken)->message.find("send a bearer token"),
            std::string::npos);
  head.authorization = "BEARER secret";
  EXPECT_FALSE(refuse_writing(head, kRemote, kOneToken));
}

// Base64 of "anybody:secret" and of "anybody:reader-1".
constexpr const char* kBasicSecret = "Basic YW55Ym9keTpzZWNyZXQ=";
constexpr const char* kBasicReader = "Basic YW55Ym9keTpyZWFkZXItMQ==";
const Guard kRoles{
    {{"reader-1", Role::Read}, {"viewer-1", Role::Images}, {"secret", Role::Control}}, true};

std::optional<Error> refusal(std::string_view authorization, Role needed, const Guard& guard,
                             const Peer& peer = kRemote) {
  RequestHead head = head_of("10.0.0.1:8080");
  head.method = needed == Role::Control ? Method::Post : Method::Get;
  if (!authorization.empty()) head.authorization = authorization;
  return refuse_access(head, peer, needed, guard);
}

TEST(Reading, NeedsNoTokenOnLoopbackUntilThereIsOneForReading) {
  EXPECT_FALSE(refusal("", Role::Read, kNoToken));
  EXPECT_FALSE(refusal("", Role::Images, kOneToken)) << "of somebody who writes";
  const Guard with_reader{{{"reader-1", Role::Read}}, false};
  EXPECT_TRUE(refusal("", Role::Read, with_reader, kLocal)) << "it may be a proxy's connection";
  EXPECT_FALSE(refusal("Bearer reader-1", Role::Read, with_reader));
}

TEST(Reading, OnAnOpenAddressIsForThisHostUntilThereAreTokens) {
  const Guard open{{}, true};
  EXPECT_FALSE(refusal("", Role::Read, open, kLocal));
  const auto refused = refusal("", Role::Read, open);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->code, ErrorCode::Unauthorized);
  EXPECT_NE(refused->message.find("http.tokens"), std::string::npos) << "what to do";
  EXPECT_TRUE(refusal("Bearer ", Role::Read, open));
  const Guard of_one_who_writes{{{"secret", Role::Control}}, true};
  EXPECT_FALSE(refusal("", Role::Read, of_one_who_writes, kLocal));
  EXPECT_TRUE(refusal("", Role::Read, of_one_who_writes));
  EXPECT_FALSE(refusal("Bearer secret", Role::Read, of_one_who_writes));
}

TEST(Roles, EachIncludesThoseBeforeIt) {
  const std::array<const char*, 3> tokens{"Bearer reader-1", "Bearer viewer-1", "Bearer secret"};
  for (std::size_t has = 0; has < 3; ++has) {
    for (std::size_t needs = 0; needs < 3; ++needs) {
      const auto refused = refusal(tokens[has], static_cast<Role>(needs), kRoles);
      EXPECT_EQ(!refused, has >= needs) << tokens[has] << needs;
      if (!refused) continue;
      EXPECT_EQ(refused->code, ErrorCode::Forbidden) << "known, but not enough";
    }
  }
  EXPECT_EQ(refusal("Bearer other", Role::Read, kRoles)->code, ErrorCode::Unauthorized);
}

TEST(Roles, HaveNames) {
  for (const Role role : {Role::Read, Role::Images, Role::Control})
    EXPECT_EQ(role_named(name_of(role)), role);
  EXPECT_FALSE(role_named("admin"));
}

TEST(Basic, IsForReadingOnly) {
  EXPECT_FALSE(refusal(kBasicReader, Role::Read, kRoles));
  EXPECT_FALSE(refusal(kBasicSecret, Role::Images, kRoles));
  EXPECT_TRUE(refusal(kBasicSecret, Role::Control, kRoles))
      << "any page can make a browser send it";
  for (const char* wrong :
       {"Basic", "Basic ", "Basic !!!!", "Basic c2VjcmV0", "Basic YW55Ym9keTp3cm9uZw=="})
    EXPECT_TRUE(refusal(wrong, Role::Read, kRoles)) << wrong;
}

TEST(Basic, DoesNotWriteByAWebSocket) {
  RequestHead head = head_of("10.0.0.1:8080");
  head.method = Method::Get;
  head.authorization = kBasicSecret;
  EXPECT_FALSE(refuse_access(head, kRemote, Role::Images, kRoles));
  EXPECT_TRUE(refuse_access(head, kRemote, Role::Control, kRoles)) << "a handshake is a GET";
}

TEST(WrongToken, IsOneThatIsNoneOfOurs) {
  RequestHead head = head_of("10.0.0.1:8080");
  EXPECT_FALSE(has_wrong_token(head, kRoles)) << "none at all";
  head.authorization = "Bearer reader-1";
  EXPECT_FALSE(has_wrong_token(head, kRoles));
  head.authorization = "Bearer reader-2";
  EXPECT_TRUE(has_wrong_token(head, kRoles));
  EXPECT_FALSE(has_wrong_token(head, kNoToken)) << "there is nothing to guess";
  head.authorization = kBasicSecret;
  head.method = Method::Post;
  EXPECT_FALSE(has_wrong_token(head, kRoles)) << "right, though refused for writing";
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
