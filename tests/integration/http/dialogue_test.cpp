// WebSockets whose clients send messages: which are allowed, what is answered, how it ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/integration/http/raw_client.h"

#include "common/http/server.h"

namespace chorus::http::test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string hello(const std::string& more = {}) {
  return "GET /talk HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
         more + "\r\n";
}

/// One masked frame of less than 64 KiB.
std::string masked(int opcode, const std::string& payload) {
  std::string frame{static_cast<char>(0x80 | opcode)};
  if (payload.size() < 126) {
    frame.push_back(static_cast<char>(0x80 | payload.size()));
  } else {
    frame.push_back(static_cast<char>(0x80 | 126));
    frame.push_back(static_cast<char>(payload.size() >> 8));
    frame.push_back(static_cast<char>(payload.size() & 0xFF));
  }
  frame += {1, 2, 3, 4};
  for (std::size_t i = 0; i < payload.size(); ++i)
    frame.push_back(static_cast<char>(payload[i] ^ static_cast<char>(i % 4 + 1)));
  return frame;
}

std::string text_frame(const std::string& payload) {
  return std::string{static_cast<char>(0x81), static_cast<char>(payload.size())} + payload;
}

struct Told {
  std::atomic<int> open = 0;
  std::atomic<int> looks = 0;
};

/// Echoes every message except "twice", "end", "throw" and "flood", which are commands.
class Echo final : public Dialogue {
 public:
  explicit Echo(std::shared_ptr<Told> told) : told_(std::move(told)) { ++told_->open; }
  ~Echo() override { --told_->open; }
  Echo(const Echo&) = delete;
  Echo& operator=(const Echo&) = delete;

  [[nodiscard]] Reply hear(std::string_view message) override {
    if (message == "twice") return {{"one", "two"}};
    if (message == "end") return {{"farewell"}, true};
    if (message == "throw") throw std::runtime_error("broken");
    if (message == "flood") return {{std::string(kMaxUnread + 1, 'x')}};
    return {{"you said " + std::string(message)}};
  }
  [[nodiscard]] Reply look() override {
    ++told_->looks;
    return {};
  }
  [[nodiscard]] Reply end(const Error& why) override { return {{"bye: " + why.message}, true}; }

 private:
  std::shared_ptr<Told> told_;
};

struct TalkServer {
  explicit TalkServer(ServerConfig config = {}) : server(std::move(config), routes()) {
    const auto started = server.start();
    EXPECT_TRUE(started) << to_string(started.error());
  }
  std::shared_ptr<const Router> routes() {
    auto router = std::make_shared<Router>();
    const auto open = [told = told](const std::string&) -> Result<std::unique_ptr<Dialogue>> {
      if (told->open > 1) return fail(ErrorCode::Unavailable, "/talk", "two talk already");
      return std::make_unique<Echo>(told);
    };
    router->dialogue("/talk", {open, "chorus.test", 200});
    router->get("/talk", [](const Request&, const PathParams&) -> Result<DocumentPtr> {
      return make_document("text/plain", "nobody talks", {"1"});
    });
    return router;
  }
  [[nodiscard]] std::string answer_to(const std::string& asked) const {
    RawClient client(server.port());
    client.say(asked);
    return client.hear_until("\r\n\r\n");
  }
  std::shared_ptr<Told> told = std::make_shared<Told>();
  Server server;
};

template <class Condition>
bool soon(const Condition& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

TEST(Dialogue, AnswersMessageByMessage) {
  TalkServer service;
  RawClient client(service.server.port());
  client.say(hello());
  EXPECT_EQ(status_in(client.hear_until("\r\n\r\n")), 101);
  client.say(masked(1, "hi"));
  EXPECT_EQ(client.hear_until("hi"), text_frame("you said hi"));
  client.say(masked(1, "twice"));
  EXPECT_EQ(client.hear_until("two"), text_frame("one") + text_frame("two"));
  EXPECT_TRUE(soon([&] { return service.told->looks > 1; })) << "it may speak unasked";
}

TEST(Dialogue, EndsWhenItSaysSo) {
  TalkServer service;
  RawClient client(service.server.port());
  client.say(hello());
  (void)client.hear_until("\r\n\r\n");
  client.say(masked(1, "end"));
  const std::string end = client.hear_until("\x88");
  EXPECT_THAT(end, HasSubstr("farewell"));
  EXPECT_TRUE(soon([&] { return service.told->open == 0; }));
  EXPECT_TRUE(soon([&] { return service.server.counters().connections_open == 0; }))
      << "also when the client does not close its side";
}

TEST(Dialogue, EndsWithTheClient) {
  TalkServer service;
  {
    RawClient client(service.server.port());
    client.say(hello());
    ASSERT_TRUE(soon([&] { return service.told->open == 1; }));
  }
  EXPECT_TRUE(soon([&] { return service.told->open == 0; }));
  EXPECT_TRUE(soon([&] { return service.server.counters().websockets_open == 0; }));
}

TEST(Dialogue, WhatGoesWrongEndsItAlone) {
  TalkServer service;
  for (const std::string& fatal : {masked(1, "throw"), masked(1, "flood"), masked(2, "binary"),
                                   masked(1, std::string(201, 'x')), text_frame("not masked")}) {
    RawClient client(service.server.port());
    client.say(hello());
    (void)client.hear_until("\r\n\r\n");
    client.say(fatal);
    EXPECT_TRUE(soon([&] { return service.told->open == 0; }));
  }
  EXPECT_EQ(status_in(service.answer_to(hello())), 101);
}

TEST(Dialogue, WhoSendsWhatCannotBeTakenIsToldSoInFull) {
  TalkServer service;
  for (const auto& [fatal, says, code] :
       {std::tuple{masked(1, std::string(201, 'x')), "at most 200 bytes", "\x03\xf1"},
        std::tuple{masked(1, std::string(1500, 'x')), "at most 200 bytes", "\x03\xf1"},
        std::tuple{masked(2, "binary"), "send text", "\x03\xeb"}}) {
    RawClient client(service.server.port());
    client.say(hello());
    (void)client.hear_until("\r\n\r\n");
    client.say(fatal);
    const std::string heard = client.hear_until(std::string("\x88\x02") + code);
    EXPECT_THAT(heard, HasSubstr(says));
    EXPECT_THAT(heard, HasSubstr(std::string("\x88\x02") + code)) << "the close code";
  }
}

TEST(Dialogue, WhoIsNotLetInGetsAProblemDocument) {
  TalkServer service;
  RawClient one(service.server.port());
  RawClient two(service.server.port());
  one.say(hello());
  two.say(hello());
  ASSERT_TRUE(soon([&] { return service.told->open == 2; }));
  const std::string answer = service.answer_to(hello());
  EXPECT_EQ(status_in(answer), 503);
}

TEST(Dialogue, APlainGetIsAnsweredBesideIt) {
  TalkServer service;
  EXPECT_EQ(status_in(service.answer_to("GET /talk HTTP/1.1\r\nHost: localhost\r\n\r\n")), 200);
}

TEST(Dialogue, NeedsTheTokenWhereThereIsOne) {
  ServerConfig config;
  config.bearer_token = "a secret/1";
  TalkServer service(config);
  EXPECT_EQ(status_in(service.answer_to(hello())), 401);
  EXPECT_EQ(status_in(service.answer_to(hello("Authorization: Bearer wrong\r\n"))), 401);
  EXPECT_EQ(status_in(service.answer_to(hello("Authorization: Bearer a secret/1\r\n"))), 101);
  EXPECT_EQ(status_in(service.answer_to(hello("Sec-WebSocket-Protocol: chorus.token.wrong\r\n"))),
            401);
  const std::string let_in = service.answer_to(
      hello("Sec-WebSocket-Protocol: chorus.test, chorus.token.a%20secret%2F1\r\n"));
  EXPECT_EQ(status_in(let_in), 101);
  EXPECT_THAT(let_in, HasSubstr("Sec-WebSocket-Protocol: chorus.test\r\n"));
  EXPECT_THAT(let_in, Not(HasSubstr("secret")));
}

TEST(Dialogue, WrongTokensAreCountedAsWithAnyOtherWriting) {
  ServerConfig config;
  config.bearer_token = "right";
  TalkServer service(config);
  const auto begun = std::chrono::steady_clock::now();
  for (int i = 0; i < 11; ++i) {
    const std::string guess = "chorus.token.wrong" + std::to_string(i);
    EXPECT_EQ(status_in(service.answer_to(hello("Sec-WebSocket-Protocol: " + guess + "\r\n"))),
              401);
  }
  EXPECT_GE(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(700));
}

TEST(Dialogue, PagesOfOtherOriginsStayOut) {
  TalkServer service;
  EXPECT_EQ(status_in(service.answer_to(hello("Origin: http://evil.example\r\n"))), 403);
  EXPECT_EQ(status_in(service.answer_to(hello("Origin: http://localhost\r\n"))), 101);
}

TEST(Dialogue, WithATokenAnAllowedPageMayWrite) {
  ServerConfig config;
  config.bearer_token = "right";
  config.allowed_origin = "https://lab.example";
  TalkServer service(config);
  const std::string token = "Sec-WebSocket-Protocol: chorus.test, chorus.token.right\r\n";
  EXPECT_EQ(status_in(service.answer_to(hello("Origin: https://lab.example\r\n" + token))), 101);
  EXPECT_EQ(status_in(service.answer_to(hello("Origin: https://lab.example\r\n"))), 401);
  EXPECT_EQ(status_in(service.answer_to(hello("Origin: https://evil.example\r\n" + token))), 403);
}

TEST(Dialogue, StopsWithTheServer) {
  auto service = std::make_unique<TalkServer>();
  RawClient client(service->server.port());
  client.say(hello());
  (void)client.hear_until("\r\n\r\n");
  service->server.stop();
  EXPECT_EQ(service->told->open, 0);
}

}  // namespace
}  // namespace chorus::http::test
