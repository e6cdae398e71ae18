// Which clients are admitted: by which host name, from which page, with which token.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "common/base/log.h"
#include "common/base/log_queue.h"
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

TEST(Strangers, APreflightTellsNothing) {
  ServerConfig config;
  config.tokens = {{"abcdefabcdef", Role::Read}};
  TestServer service(config);
  const auto body_of = [&](const std::string& path, const std::string& field = {}) {
    std::string answer =
        answer_to(service, "OPTIONS " + path + " HTTP/1.1\r\nHost: localhost\r\n" + field);
    const std::size_t date = answer.find("Test-Clock");
    return date == std::string::npos ? answer
                                     : answer.erase(date, answer.find("\r\n", date) - date);
  };
  const auto without_date = [](std::string answer) {
    const std::size_t date = answer.find("Date:");
    return date == std::string::npos ? answer
                                     : answer.erase(date, answer.find("\r\n", date) - date);
  };
  const std::string known = without_date(body_of("/frame"));
  EXPECT_EQ(status_in(known), 204);
  EXPECT_EQ(without_date(body_of("/nothing/here")), known);
  EXPECT_EQ(without_date(body_of("/frame", "Authorization: Bearer abcdefabcdef\r\n")), known);
  EXPECT_THAT(known, HasSubstr("DELETE"));
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
  for (int i = 0; i < 10; ++i) EXPECT_EQ(write("guess " + std::to_string(i)).status, 401);
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(write("one more").status, 401);
  EXPECT_GE(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(700));
  EXPECT_EQ(service.server.counters().unauthorized, 12u);
}

TEST(Strangers, TheRightTokenIsNeverHeldUpByThoseWhoGuess) {
  ServerConfig config;
  config.bearer_token = "secret";
  TestServer service(config);
  const auto write = [&](const std::string& token) {
    return service.ask("/registration", {{"Authorization", "Bearer " + token}}, "DELETE").status;
  };
  for (int i = 0; i < 10; ++i) EXPECT_EQ(write("guess " + std::to_string(i)), 401);
  int slowed = 0;
  std::thread guesser([&] { slowed = write("an eleventh"); });
  EXPECT_EQ(write("secret"), 204);
  guesser.join();
  EXPECT_EQ(slowed, 401);
}

TEST(Strangers, OneOutdatedTokenDoesNotHoldUpTheRightOne) {
  ServerConfig config;
  config.bearer_token = "secret";
  TestServer service(config);
  const auto write = [&](const std::string& token) {
    return service.ask("/registration", {{"Authorization", "Bearer " + token}}, "DELETE").status;
  };
  for (int i = 0; i < 30; ++i) EXPECT_EQ(write("outdated"), 401);
  EXPECT_EQ(write("secret"), 204);
  EXPECT_EQ(service.server.counters().unauthorized, 30u);
}

ServerConfig guarded() {
  ServerConfig config;
  config.tokens = {
      {"a reader's", Role::Read}, {"a viewer's", Role::Images}, {"the owner's", Role::Control}};
  return config;
}

TEST(Guarded, NothingButHealthIsAnsweredWithoutAToken) {
  TestServer service(guarded());
  service.frame->publish(frame_document(1));
  for (const std::string path :
       {"/frame", "/frame.json", "/frames/1", "/echo", "/nowhere", "/frame/", "/image"}) {
    const auto answer = service.ask(path);
    EXPECT_EQ(answer.status, 401) << path;
    EXPECT_THAT(answer.body, HasSubstr("Authorization: Bearer TOKEN")) << path;
    EXPECT_THAT(answer.headers.at("www-authenticate"), HasSubstr("Bearer")) << path;
  }
  EXPECT_EQ(service.ask("/frame", {}, "HEAD").status, 401);
  EXPECT_EQ(service.ask("/registration", {}, "POST", "x").status, 401);
  EXPECT_EQ(service.ask("/nowhere", {}, "DELETE").status, 401);
  EXPECT_EQ(service.ask("/health").status, 200);
}

TEST(Guarded, EachRoleGetsWhatIsItsOwn) {
  TestServer service(guarded());
  service.frame->publish(frame_document(1));
  const auto status = [&](const std::string& token, const std::string& path) {
    return service.ask(path, {{"Authorization", "Bearer " + token}}).status;
  };
  EXPECT_EQ(status("a reader's", "/frame"), 200);
  EXPECT_EQ(status("a reader's", "/nowhere"), 404);
  EXPECT_EQ(status("a reader's", "/image"), 403);
  EXPECT_EQ(status("a viewer's", "/image"), 200);
  const auto write = [&](const std::string& token) {
    return service.ask("/registration", {{"Authorization", "Bearer " + token}}, "POST", "x").status;
  };
  EXPECT_EQ(write("a viewer's"), 403);
  EXPECT_EQ(write("the owner's"), 201);
}

TEST(Guarded, GuessingAtReadingIsSlowedToo) {
  TestServer service(guarded());
  service.frame->publish(frame_document(1));
  for (int i = 0; i < 10; ++i) {
    const std::string guess = "Bearer guess " + std::to_string(i);
    EXPECT_EQ(service.ask("/frame", {{"Authorization", guess}}).status, 401);
  }
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(service.ask("/frame", {{"Authorization", "Bearer a reader's"}}).status, 200);
  EXPECT_EQ(service.ask("/frame", {{"Authorization", "Bearer one more"}}).status, 401);
  EXPECT_GE(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(700));
}

TEST(Guarded, TokensChangeWhileItServes) {
  TestServer service(guarded());
  service.server.set_tokens({{"another", Role::Read}});
  EXPECT_EQ(service.ask("/echo", {{"Authorization", "Bearer a reader's"}}).status, 401);
  EXPECT_EQ(service.ask("/echo", {{"Authorization", "Bearer another"}}).status, 200);
}

TEST(RequestLog, NamesWhoAskedForWhatAndNoSecret) {
  TestServer service(guarded());
  ::testing::internal::CaptureStderr();
  log::configure(log::Level::Debug, log::Format::Text);
  (void)service.ask("/echo?key=hidden-in-query", {{"Authorization", "Bearer a reader's"}});
  (void)service.ask("/registration", {{"Authorization", "Bearer guess"}}, "POST", "hidden-in-body");
  service.server.stop();
  ASSERT_TRUE(log::flush(std::chrono::seconds(5)));
  log::configure(log::Level::Info, log::Format::Text);
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(log, HasSubstr("path=/echo status=200 from=127.0.0.1"));
  EXPECT_THAT(log, HasSubstr("path=/registration status=401 from=127.0.0.1"));
  EXPECT_THAT(log,
              Not(::testing::AnyOf(HasSubstr("hidden"), HasSubstr("reader"), HasSubstr("guess"))));
}

}  // namespace
}  // namespace chorus::http::test
