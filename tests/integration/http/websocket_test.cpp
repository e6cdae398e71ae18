// WebSocket readers of a live document; frames are parsed by hand (RFC 6455 5.2).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/integration/http/raw_client.h"
#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using testing::HasSubstr;

// The key and its answer are those of RFC 6455 1.3.
std::string hello(const std::string& more = {}) {
  return "GET /frame HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: keep-alive, "
         "Upgrade\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
         more + "\r\n";
}

std::string masked(int opcode, const std::string& payload) {
  std::string frame{
      static_cast<char>(0x80 | opcode), static_cast<char>(0x80 | payload.size()), 1, 2, 3, 4};
  for (std::size_t i = 0; i < payload.size(); ++i) {
    frame.push_back(static_cast<char>(payload[i] ^ static_cast<char>(i % 4 + 1)));
  }
  return frame;
}

/// One unmasked frame of less than 126 bytes.
std::string text_frame(const std::string& payload) {
  return std::string{static_cast<char>(0x81), static_cast<char>(payload.size())} + payload;
}

bool open_sockets(const Server& server, std::uint64_t sockets) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (server.counters().websockets_open != sockets) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(WebSocket, EachVersionIsOneTextMessage) {
  TestServer service;
  service.frame->publish(frame_document(1));
  RawClient client(service.server.port());
  client.say(hello());
  const std::string first = client.hear_until(R"({"n":1})");
  EXPECT_EQ(status_in(first), 101);
  EXPECT_THAT(first, HasSubstr("s3pPLMBiTxaQ9kYGzzhZRbK+xOo="));
  EXPECT_THAT(first, HasSubstr(text_frame(R"({"n":1})")));
  for (int n = 2; n < 50; ++n) {
    service.frame->publish(frame_document(n));
    const std::string json = "{\"n\":" + std::to_string(n) + "}";
    ASSERT_EQ(client.hear_until(json), text_frame(json));
  }
}

TEST(WebSocket, WaitsForAFirstVersion) {
  TestServer service;
  RawClient client(service.server.port());
  client.say(hello());
  EXPECT_EQ(status_in(client.hear_until("\r\n\r\n")), 101);
  service.frame->publish(frame_document(7));
  EXPECT_EQ(client.hear_until("}"), text_frame(R"({"n":7})"));
}

TEST(WebSocket, AnswersPingAndCloseAndIgnoresTalk) {
  TestServer service;
  RawClient client(service.server.port());
  client.say(hello());
  (void)client.hear_until("\r\n\r\n");
  client.say(masked(0x1, "s") + masked(0x9, "are you there"));
  EXPECT_EQ(client.hear_until("there"), std::string("\x8A\x0D") + "are you there");
  client.say(masked(0x8, std::string("\x03\xE8", 2)));
  EXPECT_EQ(client.hear_all().substr(0, 1), "\x88");
  EXPECT_TRUE(open_sockets(service.server, 0));
}

TEST(WebSocket, WhoLeavesIsForgotten) {
  TestServer service;
  {
    RawClient client(service.server.port());
    client.say(hello());
    ASSERT_TRUE(open_sockets(service.server, 1));
  }
  EXPECT_TRUE(open_sockets(service.server, 0));
}

TEST(WebSocket, PagesOfOtherOriginsMayOpenItOnlyIfAllowed) {
  ServerConfig config;
  config.allowed_origin = "https://lab.example";
  TestServer service(config);
  RawClient stranger(service.server.port());
  stranger.say(hello("Origin: https://evil.example\r\n"));
  EXPECT_EQ(status_in(stranger.hear_until("\r\n\r\n")), 403);
  RawClient own(service.server.port());
  own.say(hello("Origin: http://localhost\r\n"));
  EXPECT_EQ(status_in(own.hear_until("\r\n\r\n")), 101);
  RawClient friendly(service.server.port());
  friendly.say(hello("Origin: https://lab.example\r\n"));
  EXPECT_EQ(status_in(friendly.hear_until("\r\n\r\n")), 101);
}

TEST(WebSocket, NoOtherPageMayOpenItByDefault) {
  TestServer service;
  for (const std::string origin : {"https://evil.example", "http://localhost:81", "null"}) {
    RawClient stranger(service.server.port());
    stranger.say(hello("Origin: " + origin + "\r\n"));
    EXPECT_EQ(status_in(stranger.hear_until("\r\n\r\n")), 403) << origin;
  }
}

TEST(WebSocket, OneVersionIsOneFrameHoweverLong) {
  TestServer service;
  const std::string text = "{\"n\":\"" + std::string(20'000, 'x') + "\"}";
  service.frame->publish(std::make_shared<const Document>(
      std::vector<Variant>{{"application/json", [text] { return text; }}}, DocumentOptions{"1"}));
  RawClient client(service.server.port());
  client.say(hello());
  const std::string heard = client.hear_until("x\"}");
  const std::size_t begin = heard.find("\r\n\r\n") + 4;
  ASSERT_GT(heard.size(), begin + 4);
  EXPECT_EQ(static_cast<unsigned char>(heard[begin]), 0x81u) << "a text message, whole";
  EXPECT_EQ(heard.substr(begin + 4), text);
}

TEST(WebSocket, OfAnythingElseIsAnOrdinaryAnswer) {
  TestServer service;
  RawClient client(service.server.port());
  std::string request = hello();
  request.replace(request.find("/frame"), 6, "/frames/1");
  client.say(request);
  EXPECT_EQ(status_in(client.hear_until("\r\n\r\n")), 200);
}

TEST(WebSocket, ABadHandshakeIsRefusedAndClosed) {
  TestServer service;
  RawClient client(service.server.port());
  client.say(
      "GET /frame HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
      "Upgrade\r\n\r\n");
  EXPECT_EQ(status_in(client.hear_all()), 400);
  EXPECT_TRUE(open_sockets(service.server, 0));
}

/// A masked frame of up to 64 kB with a chosen first byte.
std::string frame_of(int first_byte, const std::string& payload) {
  constexpr std::size_t kLongest = 125;  // for payloads this short only the short form is allowed
  std::string frame(1, static_cast<char>(first_byte));
  if (payload.size() <= kLongest) {
    frame += static_cast<char>(0x80 | payload.size());
  } else {
    frame += {static_cast<char>(0x80 | 126), static_cast<char>(payload.size() >> 8 & 0xFF),
              static_cast<char>(payload.size() & 0xFF)};
  }
  return frame + std::string(4, '\0') + payload;  // a mask of zeros
}

constexpr int kText = 0x81;
constexpr int kFirstFragment = 0x01;
constexpr int kNextFragment = 0x00;

std::string many_fragments() {
  const std::string piece(100, 'x');
  std::string flood = frame_of(kFirstFragment, piece);
  for (int i = 0; i < 60; ++i) flood += frame_of(kNextFragment, piece);
  return flood;
}

class HostileFrames : public ::testing::TestWithParam<std::string> {};

TEST_P(HostileFrames, EndTheConnectionAndNothingElse) {
  TestServer service;
  RawClient client(service.server.port());
  client.say(hello());
  ASSERT_TRUE(open_sockets(service.server, 1));
  client.say(GetParam());
  EXPECT_TRUE(open_sockets(service.server, 0));
  EXPECT_EQ(service.ask("/frames/1").status, 200);
}

INSTANTIATE_TEST_SUITE_P(
    All, HostileFrames,
    ::testing::Values(std::string("\x81\x01x", 3),  // not masked
                      std::string("\x81\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x01\x02\x03\x04",
                                  14),                             // 2^63 bytes
                      std::string("\xF3\x80\x01\x02\x03\x04", 6),  // reserved bits
                      std::string("\x83\x80\x01\x02\x03\x04", 6),  // unknown opcode
                      masked(0x8, "x"),                            // a close of one byte
                      masked(0x8, "\x03\xE8\xFF"),              // a close whose reason is not UTF-8
                      masked(0x1, "\xC3\x28"),                  // a text message that is not UTF-8
                      frame_of(kText, std::string(4097, 'x')),  // more than a client may send
                      many_fragments(),                         // the same in fragments
                      masked(0x0, "x"),                         // continuation without a start
                      std::string("\x09\x80\x01\x02\x03\x04", 6),  // a fragmented ping
                      frame_of(0x89, std::string(126, 'x')),       // a ping of more than 125 bytes
                      std::string("GET / HTTP/1.1\r\n\r\n")));

TEST(WebSocket, AReaderThatStallsIsClosedAndOthersGoOn) {
  ServerConfig config;
  config.limits.write_timeout = std::chrono::seconds(1);
  TestServer service(config);
  const auto large = [](int n) {
    return std::make_shared<const Document>(
        std::vector<Variant>{
            {"application/json", [n] { return std::string(1u << 20, 'x') + std::to_string(n); }}},
        DocumentOptions{.version = std::to_string(n)});
  };
  RawClient stalled(service.server.port(), 4096);
  stalled.say(hello());
  ASSERT_TRUE(open_sockets(service.server, 1));
  for (int n = 0; n < 20; ++n) service.frame->publish(large(n));
  EXPECT_TRUE(open_sockets(service.server, 0));
  EXPECT_EQ(service.ask("/frames/1").status, 200);
}

TEST(WebSocket, WhoPingsAndNeverReadsIsClosedAndOthersGoOn) {
  ServerConfig config;
  config.limits.write_timeout = std::chrono::seconds(1);
  config.limits.idle_timeout = std::chrono::seconds(2);
  TestServer service(config);
  RawClient deaf(service.server.port(), 4096);
  deaf.say(hello());
  ASSERT_TRUE(open_sockets(service.server, 1));
  std::string flood;
  for (int i = 0; i < 1000; ++i) flood += masked(0x9, std::string(100, 'p'));
  std::thread saying([&] {
    while (deaf.say(flood)) {
    }
  });
  EXPECT_TRUE(open_sockets(service.server, 0));
  saying.join();
  EXPECT_EQ(service.ask("/frames/1").status, 200);
}

TEST(WebSocket, WhoFloodsWithPingsAndReadsIsClosedToo) {
  TestServer service;
  RawClient client(service.server.port());
  client.say(hello());
  (void)client.hear_until("\r\n\r\n");
  const auto flood = [&](char first, int pings) {
    std::string all;
    for (int i = 0; i < pings; ++i) all += masked(0x9, {first, static_cast<char>('0' + i)});
    client.say(all);
  };
  flood('a', 40);
  EXPECT_THAT(client.hear_until(std::string{'a', static_cast<char>('0' + 39)}), HasSubstr("a0"));
  flood('b', 40);
  (void)client.hear_all();
  EXPECT_TRUE(open_sockets(service.server, 0));
}

TEST(WebSocket, LongCookiesDoNotKeepAPageOut) {
  TestServer service;
  service.frame->publish(frame_document(1));
  RawClient page(service.server.port());
  page.say(hello("Cookie: " + std::string(6000, 'c') + "\r\n"));
  EXPECT_THAT(page.hear_until(R"({"n":1})"), HasSubstr("101 "));
}

/// Waits until the server counts no open connection; false if it still counts one after 20 s.
bool no_connection(const Server& server) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (server.counters().connections_open != 0) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(WebSocket, WhoSaysTooMuchBehindTheHandshakeLeavesNothing) {
  TestServer service;
  {
    RawClient hasty(service.server.port());
    hasty.say(hello() + std::string(5000, 'x'));
    (void)hasty.hear_all();
  }
  EXPECT_TRUE(no_connection(service.server));
}

TEST(WebSocket, AServerThatStopsSaysSo) {
  TestServer service;
  RawClient client(service.server.port());
  client.say(hello());
  (void)client.hear_until("\r\n\r\n");
  ASSERT_TRUE(open_sockets(service.server, 1));
  const auto begin = std::chrono::steady_clock::now();
  std::thread stopping([&] { service.server.stop(); });
  EXPECT_EQ(client.hear_until("\xE9"), std::string("\x88\x02\x03\xE9"));
  client.say(std::string("\xF3\x80\x01\x02\x03\x04", 6));  // not a valid frame
  stopping.join();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(WebSocket, FragmentsWithoutAnEndAndWithoutBytesCostNobodyElse) {
  TestServer service;
  service.frame->publish(frame_document(1));
  RawClient empty(service.server.port());
  empty.say(hello());
  ASSERT_TRUE(open_sockets(service.server, 1));
  std::string flood = frame_of(kFirstFragment, "");
  for (int i = 0; i < 20'000; ++i) flood += frame_of(kNextFragment, "");
  empty.say(flood);
  EXPECT_EQ(service.ask("/frames/1").status, 200);
  service.frame->publish(frame_document(2));
  EXPECT_THAT(empty.hear_until(R"({"n":2})"), HasSubstr(R"({"n":2})"));
}

TEST(WebSocket, WhatComesRightBehindTheHandshakeIsRead) {
  TestServer service;
  RawClient hasty(service.server.port());
  hasty.say(hello() + masked(0x9, "soon"));
  EXPECT_THAT(hasty.hear_until("\x8A\x04soon"), HasSubstr("\x8A\x04soon"));
}

TEST(WebSocket, WhoDoesNotAnswerACloseIsHungUpOn) {
  TestServer service;
  RawClient client(service.server.port());
  client.say(hello());
  ASSERT_TRUE(open_sockets(service.server, 1));
  client.say(masked(0x8, std::string("\x03\xE8", 2)));  // the client keeps the connection open
  EXPECT_TRUE(open_sockets(service.server, 0));
  (void)client.hear_all();
  EXPECT_TRUE(client.ended());
}

TEST(WebSocket, AStoppingServerSaysGoodbye) {
  TestServer service;
  RawClient client(service.server.port());
  client.say(hello());
  ASSERT_TRUE(open_sockets(service.server, 1));
  (void)client.hear_until("\r\n\r\n");
  std::thread stopping([&] { service.server.stop(); });
  EXPECT_EQ(client.hear_until("\x03\xE9"), std::string("\x88\x02\x03\xE9"));
  client.say(masked(0x8, std::string("\x03\xE9", 2)));
  stopping.join();
}

}  // namespace
}  // namespace chorus::http::test
