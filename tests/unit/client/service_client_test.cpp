#include "common/client/service_client.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::client {
namespace {

TEST(ServiceClient, ReadsTheAuthoritiesOnceAndBeforeTheFirstRequest) {
  ::setenv("CHORUS_CA", "/nowhere/ca.crt", 1);
  const auto secure = ServiceClient::of("https://127.0.0.1:1/");
  const auto plain = ServiceClient::of("http://127.0.0.1:1/");
  ::unsetenv("CHORUS_CA");
  ASSERT_FALSE(secure);
  EXPECT_EQ(secure.error().context, "/nowhere/ca.crt");
  EXPECT_THAT(plain, chorus::testing::IsOk()) << "needs none";
}

TEST(Refusal, OfATokenNamesTheVariableThatItComesFrom) {
  const http::ClientResponse answer{401, {}, R"({"detail": "send a bearer token"})"};
  ::unsetenv("CHORUS_TOKEN");
  EXPECT_THAT(refusal_of(answer, "/").message,
              ::testing::HasSubstr("set CHORUS_TOKEN to a token of this server"));
  ::setenv("CHORUS_TOKEN", "secret", 1);
  const std::string wrong = refusal_of(answer, "/").message;
  ::unsetenv("CHORUS_TOKEN");
  EXPECT_THAT(wrong, ::testing::HasSubstr("the server does not know the token in CHORUS_TOKEN"));
  EXPECT_THAT(wrong, ::testing::Not(::testing::HasSubstr("secret")));
}

TEST(DefaultServer, HasTlsWhereInitGivesItToServices) {
  const chorus::testing::TemporaryFolder folder;
  EXPECT_EQ(default_server(folder.path().string()), "http://127.0.0.1:8080/");
  (void)folder.write("ca.crt", "an authority alone is no certificate of this host");
  EXPECT_EQ(default_server(folder.path().string()), "http://127.0.0.1:8080/");
  (void)folder.write("host.crt", "");
  EXPECT_EQ(default_server(folder.path().string()), "https://127.0.0.1:8080/");
  EXPECT_TRUE(host_has_tls(folder.path().string()));
}

}  // namespace
}  // namespace chorus::client
