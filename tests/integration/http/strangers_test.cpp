// Who is let in: by which name, from which page, with which token.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/http/route_table.h"
#include "tests/integration/http/raw_client.h"
#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string answer_to(const TestServer& service, const std::string& lines) {
  RawClient client(service.server.port());
  client.say(lines + "Connection: close\r\n\r\n");
  return client.hear_all();
}

TEST(Strangers, AForeignNameIsRefusedOnReadsAndSaysWhatToDo) {
  TestServer service;
  service.frame->publish(frame_document(1));
  const std::string answer = answer_to(service, "GET /frame HTTP/1.1\r\nHost: evil.example\r\n");
  EXPECT_EQ(status_in(answer), 421);
  EXPECT_THAT(answer, HasSubstr("http.hosts"));
  EXPECT_THAT(answer, Not(HasSubstr("<frame>")));
}

TEST(Strangers, AConfiguredNameIsOurs) {
  ServerConfig config;
  config.hosts = {"tracker.example"};
  TestServer service(config);
  service.frame->publish(frame_document(1));
  EXPECT_EQ(status_in(answer_to(service, "GET /frame HTTP/1.1\r\nHost: tracker.example:80\r\n")),
            200);
  EXPECT_EQ(status_in(answer_to(service, "GET /frame HTTP/1.1\r\nHost: evil.example\r\n")), 421);
}

TEST(Strangers, NoPageOfAnotherOriginReadsByDefault) {
  TestServer service;
  service.frame->publish(frame_document(1));
  for (const std::string method : {"GET", "OPTIONS"}) {
    EXPECT_THAT(answer_to(service, method + " /frame HTTP/1.1\r\nHost: localhost\r\n"
                                            "Origin: https://evil.example\r\n"),
                Not(HasSubstr("Access-Control-Allow-Origin")));
  }
}

TEST(Strangers, WhatShowsPeopleIsNeverForAllPages) {
  for (const auto& [origin, shown] : {std::pair{"*", false}, {"https://lab.example", true}}) {
    auto router = std::make_shared<Router>();
    router->get("/image", [](const Request&, const PathParams&) -> Result<DocumentPtr> {
      return make_document("image/png", "x", {"1"});
    });
    router->shows_people("/image");
    ServerConfig config;
    config.allowed_origin = origin;
    Server server(config, router);
    ASSERT_TRUE(server.start());
    const auto answer = fetch({"127.0.0.1", server.port(), "/"}, {"GET", "/image", {}, {}});
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->headers.contains("access-control-allow-origin"), shown) << origin;
    EXPECT_EQ(answer->headers.at("cross-origin-resource-policy"), "same-origin");
  }
}

TEST(Strangers, WrongTokensAreCountedAndSlowed) {
  ServerConfig config;
  config.bearer_token = "secret";
  TestServer service(config);
  const auto write = [&](const std::string& token) {
    return service.ask("/registration", {{"Authorization", "Bearer " + token}}, "DELETE");
  };
  EXPECT_EQ(service.ask("/registration", {}, "DELETE").status, 401) << "from loopback";
  EXPECT_EQ(write("secret").status, 204);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(write("guess").status, 401);
  const auto slowed = write("guess");
  EXPECT_EQ(slowed.status, 429);
  EXPECT_EQ(slowed.headers.at("retry-after"), "1");
  EXPECT_EQ(write("secret").status, 429) << "or a guess would tell";
  EXPECT_EQ(service.server.counters().unauthorized, 13u);
}

}  // namespace
}  // namespace chorus::http::test
