// A request with Prefer: wait and If-None-Match is held until the document changes; if it does not
// change in time, the answer is 304.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "tests/integration/http/raw_client.h"
#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using testing::HasSubstr;

std::string poll_for(int version, int wait_s, const std::string& accept = "*/*") {
  return "GET /frame HTTP/1.1\r\nHost: localhost\r\nAccept: " + accept +
         "\r\nPrefer: wait=" + std::to_string(wait_s) + "\r\nIf-None-Match: \"" +
         std::to_string(version) + "-ttl\"\r\n\r\n";
}

/// Waits until the server holds `polls` long polls; false after 10 s.
bool waiting(const Server& server, std::uint64_t polls) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (server.counters().long_polls_waiting != polls) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(LongPoll, APublishAnswersEveryWaitingClientOnce) {
  TestServer service;
  service.frame->publish(frame_document(1));
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 20; ++i) {
    clients.push_back(std::make_unique<RawClient>(service.server.port()));
    clients.back()->say(poll_for(1, 30));
  }
  ASSERT_TRUE(waiting(service.server, 20));
  service.frame->publish(frame_document(2));
  for (const auto& client : clients) {
    const std::string answer = client->hear_until(".\n");
    EXPECT_EQ(status_in(answer), 200);
    EXPECT_THAT(answer, HasSubstr("ETag: \"2-ttl\""));
    EXPECT_THAT(answer, HasSubstr("Preference-Applied: wait"));
  }
  EXPECT_TRUE(waiting(service.server, 0));
}

TEST(LongPoll, EveryVersionComesOnceOnOneConnection) {
  TestServer service;
  service.frame->publish(frame_document(1));
  RawClient client(service.server.port());
  for (int version = 1; version < 200; ++version) {
    ASSERT_TRUE(client.say(poll_for(version, 30)));
    ASSERT_TRUE(waiting(service.server, 1));
    service.frame->publish(frame_document(version + 1));
    ASSERT_THAT(client.hear_until(".\n"), HasSubstr("<n> " + std::to_string(version + 1) + " ."));
  }
}

TEST(LongPoll, AnOldTagIsAnsweredAtOnce) {
  TestServer service;
  service.frame->publish(frame_document(5));
  RawClient client(service.server.port());
  client.say(poll_for(4, 30));
  EXPECT_EQ(status_in(client.hear_until(".\n")), 200);
}

TEST(LongPoll, TheWaitIsCappedAndEndsWith304) {
  ServerConfig config;
  config.limits.max_wait = std::chrono::seconds(1);
  TestServer service(config);
  service.frame->publish(frame_document(1));
  RawClient client(service.server.port());
  const auto start = std::chrono::steady_clock::now();
  client.say(poll_for(1, 3600));
  const std::string answer = client.hear_until("\r\n\r\n");
  EXPECT_EQ(status_in(answer), 304);
  EXPECT_THAT(answer, HasSubstr("Preference-Applied: wait"));
  EXPECT_THAT(answer, HasSubstr("ETag: \"1-ttl\""));
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(700));
  client.say(poll_for(0, 30));
  EXPECT_EQ(status_in(client.hear_until(".\n")), 200) << "the connection goes on";
}

TEST(LongPoll, WaitZeroAndNoTagDoNotWait) {
  TestServer service;
  service.frame->publish(frame_document(1));
  EXPECT_EQ(service.ask("/frame", {{"Prefer", "wait=0"}, {"If-None-Match", "\"1-ttl\""}}).status,
            304);
  EXPECT_EQ(service.ask("/frame", {{"Prefer", "wait=30"}}).status, 200);
  EXPECT_EQ(service.ask("/frame", {{"Prefer", "wait=x"}, {"If-None-Match", "*"}}).status, 304);
}

TEST(LongPoll, TheSameVersionPublishedAgainKeepsWaiting) {
  TestServer service;
  service.frame->publish(frame_document(1));
  RawClient client(service.server.port());
  client.say(poll_for(1, 30));
  ASSERT_TRUE(waiting(service.server, 1));
  service.frame->publish(frame_document(1));
  EXPECT_EQ(client.hear_until(".\n", std::chrono::milliseconds(100)), "");
  EXPECT_EQ(service.server.counters().long_polls_waiting, 1u);
  service.frame->publish(frame_document(2));
  EXPECT_EQ(status_in(client.hear_until(".\n")), 200);
}

TEST(LongPoll, AClientThatLeavesIsForgotten) {
  TestServer service;
  service.frame->publish(frame_document(1));
  {
    RawClient client(service.server.port());
    client.say(poll_for(1, 30));
    ASSERT_TRUE(waiting(service.server, 1));
  }
  EXPECT_TRUE(waiting(service.server, 0));
  service.frame->publish(frame_document(2));
  EXPECT_EQ(service.ask("/frame").status, 200);
}

TEST(LongPoll, PipelinedRequestsBehindAPollWaitForIt) {
  TestServer service;
  service.frame->publish(frame_document(1));
  RawClient client(service.server.port());
  client.say(poll_for(1, 30) + "GET /frames/7 HTTP/1.1\r\nHost: localhost\r\n\r\n" +
             "POST /registration HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4\r\n\r\nab");
  ASSERT_TRUE(waiting(service.server, 1));
  client.say("cdGET /frames/8 HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  service.frame->publish(frame_document(2));
  const std::string answers = client.hear_all();
  EXPECT_EQ(times(answers, "HTTP/1.1 200"), 3u);
  EXPECT_EQ(times(answers, "HTTP/1.1 201"), 1u);
  EXPECT_LT(answers.find("2-ttl"), answers.find("7-txt"));
  EXPECT_LT(answers.find("7-txt"), answers.find("8-txt"));
  EXPECT_EQ(service.last_body, "abcd");
}

TEST(LongPoll, AStoppingServerAnswers503) {
  TestServer service;
  service.frame->publish(frame_document(1));
  RawClient client(service.server.port());
  client.say(poll_for(1, 30));
  ASSERT_TRUE(waiting(service.server, 1));
  std::thread stopper([&] { service.server.stop(); });
  const std::string answer = client.hear_until("}");
  client.leave();
  stopper.join();
  EXPECT_EQ(status_in(answer), 503);
  EXPECT_THAT(answer, HasSubstr("stopping"));
}

TEST(LongPoll, PublishersOfManyThreadsAndStoppingMeet) {
  TestServer service;
  service.frame->publish(frame_document(0));
  std::atomic<int> version = 0;
  std::vector<std::jthread> publishers;
  for (int i = 0; i < 3; ++i)
    publishers.emplace_back([&](const std::stop_token& stop) {
      while (!stop.stop_requested()) service.frame->publish(frame_document(++version));
    });
  RawClient client(service.server.port());
  for (int i = 0; i < 100; ++i) {
    client.say(poll_for(i, 30));
    EXPECT_EQ(status_in(client.hear_until(".\n")), 200);
  }
  service.server.stop();
}

}  // namespace
}  // namespace chorus::http::test
