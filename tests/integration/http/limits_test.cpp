// How many clients may come at once, and which of them is dropped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <memory>
#include <thread>
#include <vector>

#include "tests/integration/http/raw_client.h"
#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using ::testing::HasSubstr;
using Clients = std::vector<std::unique_ptr<RawClient>>;

const std::string kGet = "GET /frame HTTP/1.1\r\nHost: localhost\r\n";

std::string get_for(const std::string& address) {
  return kGet + "X-Forwarded-For: " + address + "\r\n\r\n";
}

std::string poll() { return kGet + "Prefer: wait=30\r\nIf-None-Match: \"1-ttl\"\r\n\r\n"; }

/// Sends a request and keeps the connection; returns the status.
int ask_and_stay(Clients& clients, std::uint16_t port, const std::string& request) {
  clients.push_back(std::make_unique<RawClient>(port));
  clients.back()->say(request);
  return status_in(clients.back()->hear_until(".\n"));
}

void stay_waiting(Clients& clients, const TestServer& service, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    clients.push_back(std::make_unique<RawClient>(service.server.port()));
    clients.back()->say(poll());
  }
  for (int i = 0; i < 200 && service.server.counters().long_polls_waiting < count; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_EQ(service.server.counters().long_polls_waiting, count);
}

TEST(Limits, LoopbackIsNotCountedByAddress) {
  ServerConfig config;
  config.limits.max_per_address = 4;
  TestServer service(config);
  service.frame->publish(frame_document(1));
  Clients clients;
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(ask_and_stay(clients, service.server.port(), kGet + "\r\n"), 200) << i;
}

TEST(Limits, WhomATrustedProxyNamesIsCounted) {
  ServerConfig config;
  config.trusted_proxies = {"127.0.0.1"};
  config.limits.max_per_address = 4;
  TestServer service(config);
  service.frame->publish(frame_document(1));
  Clients clients;
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(ask_and_stay(clients, service.server.port(), get_for("192.0.2.7")), 200) << i;
  RawClient fifth(service.server.port());
  fifth.say(get_for("192.0.2.7"));
  const std::string refusal = fifth.hear_all();
  EXPECT_EQ(status_in(refusal), 503);
  EXPECT_THAT(refusal, HasSubstr("too many connections"));
  EXPECT_THAT(refusal, HasSubstr("Retry-After: "));
  EXPECT_EQ(ask_and_stay(clients, service.server.port(), get_for("192.0.2.8")), 200);
  clients.clear();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(ask_and_stay(clients, service.server.port(), get_for("192.0.2.7")), 200)
      << "given back";
}

TEST(Limits, OthersAreNotBelievedWhomTheyForwardFor) {
  ServerConfig config;
  config.limits.max_per_address = 4;
  TestServer service(config);
  service.frame->publish(frame_document(1));
  Clients clients;
  for (int i = 0; i < 8; ++i)
    EXPECT_EQ(ask_and_stay(clients, service.server.port(), get_for("192.0.2.7")), 200) << i;
}

TEST(Limits, AnIdleConnectionGivesWay) {
  ServerConfig config;
  config.limits.max_connections = 8;
  TestServer service(config);
  service.frame->publish(frame_document(1));
  Clients idle;
  for (int i = 0; i < 8; ++i)
    EXPECT_EQ(ask_and_stay(idle, service.server.port(), kGet + "\r\n"), 200);
  // Longer than the time between two checks of deadlines, so that the idle connections are older
  // than the newcomers.
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  Clients newcomers;
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(ask_and_stay(newcomers, service.server.port(), kGet + "\r\n"), 200) << i;
  EXPECT_EQ(service.server.counters().closed_for_room, 3u);
  int ended = 0;
  for (const auto& client : idle) {
    client->hear_some(std::chrono::milliseconds(100));
    ended += client->ended() ? 1 : 0;
  }
  EXPECT_EQ(ended, 3) << "those that have been idle for longest";
}

TEST(Limits, WhoIsServedStaysAndMonitorsGetThrough) {
  ServerConfig config;
  config.limits.max_connections = 8;
  TestServer service(config);
  service.frame->publish(frame_document(1));
  Clients waiting;
  stay_waiting(waiting, service, 8);
  RawClient late(service.server.port());
  late.say(kGet + "\r\n");
  EXPECT_EQ(status_in(late.hear_all()), 503);
  EXPECT_EQ(service.ask("/vital").status, 200);
  service.frame->publish(frame_document(2));
  for (const auto& client : waiting) EXPECT_EQ(status_in(client->hear_until(".\n")), 200);
}

TEST(Limits, LongPolls) {
  ServerConfig config;
  config.limits.max_long_polls = 3;
  TestServer service(config);
  service.frame->publish(frame_document(1));
  Clients waiting;
  stay_waiting(waiting, service, 3);
  RawClient fourth(service.server.port());
  fourth.say(poll());
  EXPECT_EQ(status_in(fourth.hear_all()), 503);
  EXPECT_EQ(service.ask("/frame").status, 200) << "at once is always possible";
}

TEST(Limits, TheSoftLimitOfDescriptorsIsRaised) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit low{256, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &low), 0);
  const TestServer service;
  rlimit after{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &after), 0);
  EXPECT_EQ(after.rlim_cur, std::min<rlim_t>(before.rlim_max, 65'536));
}

}  // namespace
}  // namespace chorus::http::test
