// The clients against our server, and against servers that misbehave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "common/net/asio.h"
#include "tests/integration/http/scripted_server.h"
#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

Result<ClientResponse> fetch_from(std::uint16_t port, ClientLimits limits = {}) {
  return fetch({"127.0.0.1", port, "/"}, {}, limits);
}

ErrorCode failure(const std::string& answer, ClientLimits limits = {}) {
  ScriptedServer server({answer});
  const auto result = fetch_from(server.port(), limits);
  EXPECT_FALSE(result) << answer;
  return result ? ErrorCode::Conflict : result.error().code;
}

TEST(Fetch, ReadsEveryFraming) {
  ScriptedServer server(
      {"HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\nok",
       "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n2\r\nok\r\n0\r\n\r\n",
       "HTTP/1.0 200 OK\r\n\r\nok",
       "HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\nok"});
  for (int i = 0; i < 4; ++i) {
    const auto answer = fetch_from(server.port());
    ASSERT_TRUE(answer) << i << to_string(answer.error());
    EXPECT_EQ(answer->body, "ok") << i;
    EXPECT_GE(answer->received_ns, answer->sent_ns);
  }
}

TEST(Fetch, BrokenAnswersAreErrorsWithAReason) {
  EXPECT_EQ(failure("nonsense\r\n\r\n"), ErrorCode::Malformed);
  EXPECT_EQ(failure("HTTP/1.1 200 OK\r\nContent-Length: 100\r\n\r\ncut"), ErrorCode::Unavailable);
  EXPECT_EQ(failure("HTTP/1.1 200 OK\r\nX: " + std::string(100000, 'a') + "\r\n\r\n"),
            ErrorCode::Malformed);
  EXPECT_EQ(failure("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n1;" +
                    std::string(1U << 20U, 'e')),
            ErrorCode::Malformed);
  ClientLimits small;
  small.max_body_bytes = 10;
  EXPECT_EQ(failure("HTTP/1.1 200 OK\r\nContent-Length: 11\r\n\r\n01234567890", small),
            ErrorCode::TooLarge);
  EXPECT_EQ(failure("HTTP/1.1 200 OK\r\n\r\n01234567890", small), ErrorCode::TooLarge);
}

TEST(Fetch, SilenceIsATimeout) {
  ClientLimits hasty;
  hasty.answer_timeout = milliseconds(100);
  EXPECT_EQ(failure("", hasty), ErrorCode::Timeout);
}

TEST(Fetch, NobodyThereIsUnavailable) {
  const auto refused = fetch_from(1);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(refused.error().context, HasSubstr("127.0.0.1:1"));
}

TEST(Fetch, FindsHostsByName) {
  TestServer service;
  const auto answer = fetch({"localhost", service.server.port(), "/frames/9"}, {});
  ASSERT_TRUE(answer) << to_string(answer.error());
  EXPECT_EQ(answer->body, "9");
}

TEST(Fetch, NeverWritesASecondHeaderOrRequest) {
  for (const ClientRequest& request :
       {ClientRequest{"GET", "/a\r\nX: y"}, ClientRequest{"GET", "/a b"},
        ClientRequest{"GET", "/", {{"X", "a\r\nY: b"}}}, ClientRequest{"GET /", "/"}}) {
    const auto refused = fetch({"127.0.0.1", 1, "/"}, request);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
  }
}

class AsyncClientTest : public testing::Test {
 protected:
  /// Runs until the answer is there.
  Result<ClientResponse> ask(AsyncClient& client, const std::string& target) {
    std::optional<Result<ClientResponse>> answer;
    client.send({"GET", target}, milliseconds(5000), [&](auto result) { answer = result; });
    io_.restart();
    while (!answer && io_.run_one() > 0) {
    }
    EXPECT_TRUE(answer);
    return answer ? *answer : fail(ErrorCode::Internal, "", "no callback");
  }
  asio::io_context io_{1};
};

TEST_F(AsyncClientTest, KeepsItsConnection) {
  TestServer service;
  AsyncClient client(io_, "127.0.0.1", service.server.port());
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(ask(client, "/frames/" + std::to_string(i))->body, std::to_string(i));
  EXPECT_EQ(service.server.counters().connections_total, 1u);
}

TEST_F(AsyncClientTest, AsksAgainWhenAKeptConnectionWasClosed) {
  auto service = std::make_unique<TestServer>();
  ServerConfig config;
  config.port = service->server.port();
  AsyncClient client(io_, "127.0.0.1", config.port);
  EXPECT_EQ(ask(client, "/frames/1")->body, "1");
  service.reset();
  EXPECT_EQ(ask(client, "/frames/2").error().code, ErrorCode::Unavailable);
  service = std::make_unique<TestServer>(config);
  EXPECT_EQ(ask(client, "/frames/3")->body, "3");
  service.reset();
  service = std::make_unique<TestServer>(config);
  EXPECT_EQ(ask(client, "/frames/4")->body, "4") << "on a new connection, without an error";
}

TEST_F(AsyncClientTest, TheCallbackMaySendAgain) {
  TestServer service;
  AsyncClient client(io_, "127.0.0.1", service.server.port());
  int answers = 0;
  AsyncClient::Callback again = [&](Result<ClientResponse> result) {
    ASSERT_TRUE(result);
    if (++answers < 20) client.send({"GET", "/frames/1"}, milliseconds(5000), again);
  };
  client.send({"GET", "/frames/1"}, milliseconds(5000), again);
  io_.run();
  EXPECT_EQ(answers, 20);
}

TEST_F(AsyncClientTest, NoCallbackAfterCloseOrDestruction) {
  TestServer service;
  service.frame->publish(frame_document(1));
  for (const bool destroy : {false, true}) {
    auto client = std::make_unique<AsyncClient>(io_, "127.0.0.1", service.server.port());
    client->send({"GET", "/frame", {{"Prefer", "wait=30"}, {"If-None-Match", "\"1-ttl\""}}},
                 milliseconds(60000), [](auto) { FAIL() << "called back"; });
    asio::post(io_, [&] { destroy ? client.reset() : client->close(); });
    io_.restart();
    io_.run();
  }
}

TEST_F(AsyncClientTest, TheCallbackMayDestroyTheClient) {
  TestServer service;
  auto client = std::make_unique<AsyncClient>(io_, "127.0.0.1", service.server.port());
  bool called = false;
  client->send({"GET", "/frames/1"}, milliseconds(5000), [&](auto) {
    client.reset();
    called = true;
  });
  io_.run();
  EXPECT_TRUE(called);
}

TEST_F(AsyncClientTest, OneRequestAtATime) {
  TestServer service;
  AsyncClient client(io_, "127.0.0.1", service.server.port());
  std::vector<std::string> seen;
  client.send({"GET", "/frames/1"}, milliseconds(5000), [&](auto r) { seen.push_back(r->body); });
  client.send({"GET", "/frames/2"}, milliseconds(5000),
              [&](auto r) { seen.emplace_back(name_of(r.error().code)); });
  io_.run();
  EXPECT_THAT(seen, testing::UnorderedElementsAre("1", "conflict"));
}

TEST_F(AsyncClientTest, ATimeoutDropsTheConnectionAndTheNextRequestWorks) {
  TestServer service;
  service.frame->publish(frame_document(1));
  AsyncClient client(io_, "127.0.0.1", service.server.port());
  std::optional<ErrorCode> failed;
  client.send({"GET", "/frame", {{"Prefer", "wait=30"}, {"If-None-Match", "\"1-ttl\""}}},
              milliseconds(50), [&](auto result) { failed = result.error().code; });
  io_.run();
  EXPECT_EQ(failed, ErrorCode::Timeout);
  EXPECT_EQ(ask(client, "/frames/5")->body, "5");
}

TEST_F(AsyncClientTest, BytesBehindAnAnswerAreNeverTheNextAnswer) {
  ScriptedServer server(
      {"HTTP/1.1 200 OK\r\nContent-Length: 1\r\n\r\n1HTTP/1.1 200 OK\r\nContent-Length: 1\r\n\r\nX",
       "HTTP/1.1 200 OK\r\nContent-Length: 1\r\n\r\n2"});
  AsyncClient client(io_, "127.0.0.1", server.port());
  EXPECT_EQ(ask(client, "/")->body, "1");
  EXPECT_EQ(ask(client, "/")->body, "2");
}

}  // namespace
}  // namespace chorus::http::test
