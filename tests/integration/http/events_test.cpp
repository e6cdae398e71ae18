// Server-sent events of a live document.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/integration/http/raw_client.h"
#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string subscribe(const std::string& more = {}) {
  return "GET /frame HTTP/1.1\r\nHost: localhost\r\nAccept: text/event-stream\r\n" + more + "\r\n";
}

bool open_streams(const Server& server, std::uint64_t streams) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (server.counters().event_streams_open != streams) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(Events, EachPublishIsOneEvent) {
  TestServer service;
  service.frame->publish(frame_document(1));
  RawClient client(service.server.port());
  client.say(subscribe());
  const std::string first = client.hear_until("{\"n\":1}\n\n");
  EXPECT_EQ(status_in(first), 200);
  EXPECT_THAT(first, HasSubstr("Content-Type: text/event-stream\r\n"));
  EXPECT_THAT(first, HasSubstr("\r\n\r\nretry: 1000\n\nid: 1\ndata: {\"n\":1}\n\n"));
  for (int version = 2; version < 50; ++version) {
    service.frame->publish(frame_document(version));
    const std::string number = std::to_string(version);
    ASSERT_EQ(client.hear_until("}\n\n"), "id: " + number + "\ndata: {\"n\":" + number + "}\n\n");
  }
}

TEST(Events, CarryTurtleForWhoLikesItBetterThanJson) {
  TestServer service;
  service.frame->publish(frame_document(1));
  const auto asked = [&](const std::string& accept, std::string_view end) {
    RawClient client(service.server.port());
    client.say("GET /frame HTTP/1.1\r\nHost: localhost\r\nAccept: " + accept + "\r\n\r\n");
    return client.hear_until(end);
  };
  EXPECT_THAT(asked("text/event-stream, text/turtle;q=0.9, application/json;q=0.8", "data: \n\n"),
              HasSubstr("\n\nid: 1\ndata: <frame> <n> 1 .\ndata: \n\n"));
  for (const char* json : {"text/event-stream, application/json;q=0.9, text/turtle;q=0.8",
                           "text/event-stream, */*;q=0.1"})
    EXPECT_THAT(asked(json, "}\n\n"), HasSubstr("\n\nid: 1\ndata: {\"n\":1}\n\n")) << json;
}

TEST(Events, AReturningReaderGetsTheNextOne) {
  TestServer service;
  service.frame->publish(frame_document(3));
  RawClient client(service.server.port());
  client.say(subscribe("Last-Event-ID: 3\r\n"));
  client.hear_until("retry: 1000\n\n");
  service.frame->publish(frame_document(4));
  EXPECT_EQ(client.hear_until("}\n\n"), "id: 4\ndata: {\"n\":4}\n\n");
}

TEST(Events, OnlyWhoNamesTheTypeGetsAStream) {
  TestServer service;
  service.frame->publish(frame_document(1));
  EXPECT_EQ(service.ask("/frame", {{"Accept", "text/*"}}).headers.at("content-type"),
            "text/turtle");
  const auto both = service.ask("/frame", {{"Accept", "text/event-stream;q=0.5, */*"}});
  EXPECT_EQ(both.headers.at("content-type"), "text/turtle");
  const auto head = service.ask("/frame", {{"Accept", "text/event-stream"}}, "HEAD");
  EXPECT_EQ(head.headers.at("content-type"), "text/event-stream");
}

TEST(Events, AReaderThatLeavesIsForgotten) {
  TestServer service;
  service.frame->publish(frame_document(1));
  {
    RawClient client(service.server.port());
    client.say(subscribe());
    ASSERT_TRUE(open_streams(service.server, 1));
  }
  EXPECT_TRUE(open_streams(service.server, 0));
}

TEST(Events, ASlowReaderSkipsFramesAndGetsTheNewest) {
  TestServer service;
  const auto large = [](int version) {
    DocumentOptions options;
    options.version = std::to_string(version);
    return make_document("application/json", '"' + std::string(200'000, 'x') + '"', options);
  };
  service.frame->publish(large(1));
  RawClient client(service.server.port(), 4096);
  client.say(subscribe());
  ASSERT_TRUE(open_streams(service.server, 1));
  constexpr int kLast = 40;
  for (int version = 2; version <= kLast; ++version) {
    service.frame->publish(large(version));
    (void)service.ask("/frames/1");  // By then the server's thread has seen the publish.
  }
  EXPECT_GT(service.server.counters().events_skipped, 20u);
  const std::string heard = client.hear_until("id: " + std::to_string(kLast) + "\n");
  EXPECT_THAT(heard, HasSubstr("id: 40\n"));
  EXPECT_THAT(heard, Not(HasSubstr("id: 30\n")));
}

TEST(Events, LittleWaitsForAReaderWhoStopsForAWhile) {
  TestServer service;
  const auto usual = [](int version) {
    DocumentOptions options;
    options.version = std::to_string(version);
    return make_document("application/json", '"' + std::string(5'500, 'x') + '"', options);
  };
  service.frame->publish(usual(1));
  constexpr int kReceiveBuffer = 16 * 1024;  // The kernel doubles it.
  RawClient client(service.server.port(), kReceiveBuffer);
  client.say(subscribe());
  (void)client.hear_until("x\"\n\n");
  constexpr int kLast = 300;  // ten seconds
  for (int version = 2; version <= kLast; ++version) {
    service.frame->publish(usual(version));
    (void)service.ask("/frames/1");  // By then the server's thread has seen the publish.
  }
  const std::string heard = client.hear_until("id: " + std::to_string(kLast) + "\n");
  // About six frames are already in the receive buffer of the reader's kernel and cannot be
  // dropped.
  EXPECT_LE(times(heard, "id: "), 9u);
}

TEST(Events, ADocumentWithoutJsonStreamsNothing) {
  TestServer service;
  service.frame->publish(make_document("text/plain", "x", {"1"}));
  RawClient client(service.server.port());
  client.say(subscribe());
  client.hear_until("retry: 1000\n\n");
  service.frame->publish(frame_document(2));
  EXPECT_EQ(client.hear_until("}\n\n"), "id: 2\ndata: {\"n\":2}\n\n");
}

}  // namespace
}  // namespace chorus::http::test
