#include <gmock/gmock.h>

#include <optional>
#include <random>
#include <thread>

#include "common/http/event_stream_client.h"
#include "common/net/asio.h"
#include "tests/integration/http/test_server.h"
#include "tests/integration/http/tls_client.h"
#include "tests/support/workshop_authority.h"

namespace chorus::http {
namespace {

using test::RawClient;
using test::TestServer;
using test::TlsRawClient;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

const testing::WorkshopAuthority& workshop() {
  static const testing::WorkshopAuthority authority;
  return authority;
}

ServerConfig secured(const std::vector<std::string>& hosts = {"localhost", "127.0.0.1"}) {
  ServerConfig config;
  config.identity = workshop().identity(hosts);
  return config;
}

Url secure_url(const TestServer& service, std::string target = "/",
               std::string host = "127.0.0.1") {
  return {std::move(host), service.server.port(), std::move(target), true};
}

Result<ClientResponse> ask(const TestServer& service, const std::string& target,
                           const ClientRequest& request = {}) {
  return fetch(secure_url(service, target), request, {}, workshop().trust());
}

std::string error_of(const Result<ClientResponse>& answer) {
  return answer ? "answered" : answer.error().message;
}

TEST(Tls, AnswersRequestsOfAllSizes) {
  TestServer service(secured());
  service.frame->publish(test::frame_document(1));
  for (int i = 0; i < 3; ++i) {
    const auto answer = ask(service, "/frames/9");
    ASSERT_TRUE(answer) << to_string(answer.error());
    EXPECT_EQ(answer->body, "9");
  }
  const auto big = ask(service, "/big");
  ASSERT_TRUE(big) << to_string(big.error());
  EXPECT_EQ(big->body, std::string(8u << 20, 'x'));
  const std::string body(60000, 'b');
  EXPECT_EQ(ask(service, "/registration", {.method = "POST", .body = body})->status, 201);
  EXPECT_EQ(service.last_body, body);
  EXPECT_EQ(service.server.counters().handshakes_failed, 0);
}

TEST(Tls, AConnectionIsKept) {
  TestServer service(secured());
  asio::io_context io(1);
  AsyncClient client(io, secure_url(service), {}, workshop().trust());
  for (int i = 0; i < 3; ++i) {
    std::optional<Result<ClientResponse>> answer;
    client.send({.target = "/frames/7"}, 5s,
                [&](Result<ClientResponse> r) { answer = std::move(r); });
    io.restart();
    while (!answer && io.run_one() > 0) {
    }
    ASSERT_TRUE(answer && *answer);
    EXPECT_EQ((*answer)->body, "7");
  }
  EXPECT_EQ(service.server.counters().connections_total, 1);
}

TEST(Tls, ALongPollIsWoken) {
  TestServer service(secured());
  service.frame->publish(test::frame_document(1));
  const auto first = ask(service, "/frame");
  ASSERT_TRUE(first);
  std::thread later([&] {
    std::this_thread::sleep_for(100ms);
    service.frame->publish(test::frame_document(2));
  });
  const auto second =
      ask(service, "/frame",
          {.headers = {{"If-None-Match", first->headers.at("etag")}, {"Prefer", "wait=5"}}});
  later.join();
  ASSERT_TRUE(second);
  EXPECT_THAT(second->body, HasSubstr("2"));
}

TEST(Tls, AnEventStreamCarriesEveryVersion) {
  TestServer service(secured());
  asio::io_context io(1);
  AsyncEventStream stream(io, secure_url(service), {}, workshop().trust());
  service.frame->publish(test::frame_document(1));
  std::string seen;
  AsyncEventStream::Handlers handlers;
  handlers.on_head = [](const ClientResponse&) {};
  handlers.on_events = [&](const std::vector<ServerEvent>& events) {
    seen += events.back().data;
    if (seen.size() > 40) return stream.close();
    service.frame->publish(test::frame_document(static_cast<int>(seen.size())));
  };
  handlers.on_end = [&](const Error& why) { seen = to_string(why); };
  stream.open({.target = "/frame", .headers = {{"Accept", "text/event-stream"}}}, handlers);
  io.run_for(10s);
  EXPECT_THAT(seen, HasSubstr("{\"n\":1}{\"n\":7}{\"n\":14}"));
}

TEST(Tls, AWebSocketCarriesEveryVersion) {
  TestServer service(secured());
  service.frame->publish(test::frame_document(1));
  TlsRawClient client(service.server.port(), workshop().trust());
  ASSERT_TRUE(client.sealed());
  client.say(
      "GET /frame HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  EXPECT_THAT(client.hear_until("{\"n\":1}"), HasSubstr("101 Switching Protocols"));
  service.frame->publish(test::frame_document(2));
  EXPECT_THAT(client.hear_until("{\"n\":2}"), HasSubstr("{\"n\":2}"));
  // Waits until nothing is being written: during a write the server would close without a close
  // frame.
  std::this_thread::sleep_for(100ms);
  std::thread stopping([&] { service.server.stop(); });
  EXPECT_THAT(client.hear_all(), HasSubstr("\x88\x02\x03\xe9"));  // a close frame: going away
  EXPECT_TRUE(client.said_end());
  client.raw().leave();
  stopping.join();
}

TEST(Tls, TheLastAnswerEndsProperly) {
  TestServer service(secured());
  TlsRawClient client(service.server.port(), workshop().trust());
  client.say("GET /frames/9 HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(client.hear_all(), HasSubstr("200 OK"));
  EXPECT_TRUE(client.said_end());
}

TEST(Tls, PlainHttpIsToldWhatToDo) {
  TestServer service(secured());
  RawClient client(service.server.port());
  client.say("GET /frame HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::string answer = client.hear_all();
  EXPECT_EQ(test::status_in(answer), 400);
  EXPECT_THAT(answer, HasSubstr("https://"));
  // A token that came unencrypted is not even checked.
  const auto written = fetch(service.url("/registration"), {.method = "POST", .body = "x"});
  ASSERT_TRUE(written);
  EXPECT_EQ(written->status, 400);
  EXPECT_EQ(service.last_body, "");
}

TEST(Tls, ASecureClientIsToldOfAPlainServer) {
  TestServer service;
  EXPECT_THAT(error_of(ask(service, "/frame")), HasSubstr("write http://"));
}

TEST(Tls, ObjectionsReachTheCaller) {
  TestServer service(secured({"sensor-1", "10.0.0.11"}));
  const auto wrong = error_of(ask(service, "/"));
  EXPECT_THAT(wrong, HasSubstr("is for sensor-1, 10.0.0.11, not for 127.0.0.1"));
  const testing::WorkshopAuthority stranger;
  EXPECT_THAT(error_of(fetch(secure_url(service), {}, {}, stranger.trust())),
              HasSubstr("name the ca.crt"));
  EXPECT_THAT(error_of(fetch(secure_url(service), {})), HasSubstr("authorities of this system"));
  EXPECT_EQ(service.server.counters().requests, 0);
}

TEST(Tls, ACertificateIsReplacedWhileRunning) {
  ServerConfig config = secured();
  const tls::Issued old = workshop().issue_expired({"127.0.0.1"});
  config.identity = tls::Identity::of(old.certificate, old.key).value();
  TestServer service(config);
  EXPECT_THAT(error_of(ask(service, "/frames/1")), HasSubstr("has expired"));
  service.server.set_identity(workshop().identity());
  EXPECT_TRUE(ask(service, "/frames/1"));
}

TEST(Tls, AnOpenConnectionOutlivesItsCertificate) {
  TestServer service(secured());
  TlsRawClient client(service.server.port(), workshop().trust());
  const testing::WorkshopAuthority other;
  service.server.set_identity(other.identity());
  EXPECT_FALSE(ask(service, "/frames/1"));
  client.say("GET /frames/9 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(client.hear_until("\r\n\r\n9"), HasSubstr("200 OK"));
}

TEST(Tls, WhoDoesNotShakeHandsIsCutOff) {
  ServerConfig config = secured();
  config.limits.header_timeout = 1s;
  TestServer service(config);
  RawClient silent(service.server.port());
  RawClient slow(service.server.port());
  slow.say("\x16\x03\x01\x02");
  const auto before = std::chrono::steady_clock::now();
  silent.hear_all(4s);
  slow.hear_all(4s);
  EXPECT_TRUE(silent.ended());
  EXPECT_TRUE(slow.ended());
  EXPECT_LT(std::chrono::steady_clock::now() - before, 3s);
  EXPECT_TRUE(ask(service, "/frames/1"));
}

TEST(Tls, WhoDoesNotShakeHandsMakesRoomForOthers) {
  ServerConfig config = secured();
  config.limits.max_connections = 8;
  TestServer service(config);
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < 8; ++i) silent.push_back(std::make_unique<RawClient>(service.server.port()));
  for (int i = 0; i < 3; ++i) {
    const auto answer = ask(service, "/frames/1");
    ASSERT_TRUE(answer) << to_string(answer.error());
    EXPECT_EQ(answer->status, 200);
  }
  EXPECT_GE(service.server.counters().closed_for_room, 1);
}

TEST(Tls, GarbageCostsItsOwnConnection) {
  TestServer service(secured());
  std::minstd_rand random(3);
  for (int round = 0; round < 200; ++round) {
    std::string bytes = round % 2 == 0 ? "\x16\x03\x01" : "";
    for (std::size_t size = random() % 300; size > 0; --size)
      bytes.push_back(static_cast<char>(random()));
    RawClient client(service.server.port());
    client.say(bytes);
  }
  TlsRawClient half(service.server.port(), workshop().trust());
  half.raw().say(std::string(400, '\x17'));  // garbage after a good handshake
  half.raw().hear_all(2s);
  EXPECT_TRUE(half.raw().ended());
  EXPECT_TRUE(ask(service, "/frames/1"));
}

TEST(Tls, StopsWhileHandsAreShaken) {
  TestServer service(secured());
  RawClient silent(service.server.port());
  ASSERT_TRUE(ask(service, "/frames/1"));
  const auto before = std::chrono::steady_clock::now();
  service.server.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - before, 1s);
}

}  // namespace
}  // namespace chorus::http
