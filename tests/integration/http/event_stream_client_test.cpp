// Our reader of event streams, against our server and against servers that misbehave.
#include "common/http/event_stream_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "tests/integration/http/scripted_server.h"
#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

const ClientRequest kAsking{"GET", "/frame", {{"Accept", "text/event-stream, text/turtle;q=0.9"}}};

const std::string kChunked =
    "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nTransfer-Encoding: chunked\r\n\r\n";

/// What a stream delivered, in order.
struct Heard {
  std::optional<ClientResponse> head;
  std::vector<ServerEvent> events;
  std::optional<Error> end;
};

class EventStreamClient : public testing::Test {
 protected:
  AsyncEventStream::Handlers handlers() {
    return {[this](const ClientResponse& head) { heard_.head = head; },
            [this](const std::vector<ServerEvent>& events) {
              heard_.events.insert(heard_.events.end(), events.begin(), events.end());
            },
            [this](const Error& error) { heard_.end = error; }};
  }
  template <class Holds>
  void run_until(const Holds& holds) {
    io_.restart();
    while (!holds() && io_.run_one_for(std::chrono::seconds(10)) > 0) {
    }
    EXPECT_TRUE(holds());
  }
  /// The error at the end of a stream whose server answers with these bytes.
  Error end_of(const std::string& answer, ClientLimits limits = {}) {
    ScriptedServer server({answer});
    AsyncEventStream stream(io_, "127.0.0.1", server.port(), limits);
    stream.open(kAsking, handlers());
    run_until([this] { return heard_.end.has_value(); });
    return heard_.end.value_or(Error{});
  }

  asio::io_context io_{1};
  Heard heard_;
};

TEST_F(EventStreamClient, HearsEveryPublishInTurtle) {
  TestServer service;
  service.frame->publish(frame_document(1));
  AsyncEventStream stream(io_, "localhost", service.server.port());
  stream.open(kAsking, handlers());
  for (std::size_t n = 1; n < 50; ++n) {
    run_until([&] { return heard_.events.size() >= n; });
    const std::string number = std::to_string(n);
    ASSERT_EQ(heard_.events.back(), (ServerEvent{number, "<frame> <n> " + number + " .\n"}));
    service.frame->publish(frame_document(static_cast<int>(n) + 1));
  }
  ASSERT_TRUE(heard_.head);
  EXPECT_EQ(heard_.head->status, 200);
  EXPECT_TRUE(heard_.head->headers.contains("test-clock"));
  EXPECT_GE(heard_.head->received_ns, heard_.head->sent_ns);
  EXPECT_FALSE(heard_.end);
}

TEST_F(EventStreamClient, ReadsChunksAndSaysWhenTheStreamEnds) {
  const Error end = end_of(
      "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream; charset=utf-8\r\n"
      "Transfer-Encoding: chunked\r\n\r\n9\r\ndata: a\n\n\r\nb\r\ndata: b\n\nda\r\n0\r\n\r\n");
  EXPECT_EQ(heard_.events, (std::vector<ServerEvent>{{"", "a"}, {"", "b"}}));
  EXPECT_EQ(end.code, ErrorCode::Unavailable);
}

TEST_F(EventStreamClient, AnythingElseIsUnsupportedAndItsHeadIsTold) {
  const Error end =
      end_of("HTTP/1.1 200 OK\r\nContent-Type: text/turtle\r\nContent-Length: 3\r\n\r\n<a>");
  EXPECT_EQ(end.code, ErrorCode::Unsupported);
  ASSERT_TRUE(heard_.head);
  EXPECT_EQ(heard_.head->headers.at("content-type"), "text/turtle");
  EXPECT_TRUE(heard_.events.empty());
}

TEST_F(EventStreamClient, EndlessEventsAndSilentServersAreGivenUp) {
  ClientLimits small;
  small.max_body_bytes = 100;
  small.answer_timeout = milliseconds(100);
  EXPECT_EQ(end_of("HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\n\r\ndata: " +
                       std::string(200, 'x'),
                   small)
                .code,
            ErrorCode::TooLarge);
  heard_ = {};
  EXPECT_EQ(end_of("", small).code, ErrorCode::Timeout);
}

TEST_F(EventStreamClient, AnEventDoesNotWaitForTheRestOfAChunksHead) {
  ScriptedServer server({kChunked + "9\r\ndata: a\n\n\r\n1"}, ScriptedServer::Afterwards::Stay);
  AsyncEventStream stream(io_, "127.0.0.1", server.port());
  stream.open(kAsking, handlers());
  run_until([this] { return !heard_.events.empty(); });
  EXPECT_EQ(heard_.events, (std::vector<ServerEvent>{{"", "a"}}));
}

TEST_F(EventStreamClient, TheHeadOfAChunkIsLimited) {
  const Error end = end_of(kChunked + "1;" + std::string(1U << 20U, 'e'));
  EXPECT_EQ(end.code, ErrorCode::Unavailable);
  EXPECT_THAT(end.message, HasSubstr("buffer overflow"));
}

TEST_F(EventStreamClient, CommentsWithoutEndAreGivenUp) {
  ClientLimits small;
  small.max_body_bytes = 100;
  std::string comments = "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\n\r\n";
  for (int i = 0; i < 100; ++i) comments += ":\n\n";
  EXPECT_EQ(end_of(comments, small).code, ErrorCode::TooLarge);
}

TEST_F(EventStreamClient, NobodyThereIsUnavailable) {
  AsyncEventStream stream(io_, "127.0.0.1", 1);
  stream.open(kAsking, handlers());
  run_until([this] { return heard_.end.has_value(); });
  EXPECT_EQ(heard_.end->code, ErrorCode::Unavailable);
  EXPECT_THAT(heard_.end->message, HasSubstr("cannot connect"));
}

TEST_F(EventStreamClient, APauseHoldsTheReadingBack) {
  TestServer service;
  service.frame->publish(frame_document(1));
  AsyncEventStream stream(io_, "127.0.0.1", service.server.port());
  auto with_pause = handlers();
  with_pause.on_events = [&](const std::vector<ServerEvent>& events) {
    heard_.events.insert(heard_.events.end(), events.begin(), events.end());
    stream.pause(milliseconds(200));
  };
  stream.open(kAsking, with_pause);
  run_until([this] { return heard_.events.size() == 1; });
  const auto begun = std::chrono::steady_clock::now();
  service.frame->publish(frame_document(2));
  run_until([this] { return heard_.events.size() == 2; });
  EXPECT_GE(std::chrono::steady_clock::now() - begun, milliseconds(150));
}

TEST_F(EventStreamClient, MayBeClosedAndOpenedAgainFromItsOwnHandlers) {
  TestServer service;
  service.frame->publish(frame_document(1));
  AsyncEventStream stream(io_, "127.0.0.1", service.server.port());
  auto closing = handlers();
  closing.on_head = [&](const ClientResponse&) { stream.open(kAsking, handlers()); };
  stream.open(kAsking, closing);
  run_until([this] { return heard_.events.size() == 1; });
  stream.close();
  EXPECT_FALSE(heard_.end);
}

}  // namespace
}  // namespace chorus::http::test
