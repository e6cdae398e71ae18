// A server continues to accept, whatever its handlers throw.
#include "common/net/listen.h"

#include <new>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/net/event_loop.h"
#include "common/net/every.h"

namespace chorus::net {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

TEST(AcceptLoop, WhatAConnectionsWelcomeThrowsCostsThatOneAlone) {
  asio::io_context io{1};
  std::vector<Socket> welcomed;
  int came = 0;
  AcceptLoop accepting(io, "accept failed", [&](Socket socket) {
    if (++came == 1) throw std::bad_alloc();
    welcomed.push_back(std::move(socket));
    if (came == 3) accepting.stop();
  });
  ASSERT_TRUE(accepting.listen({"127.0.0.1", 0, "test.port"}));
  std::vector<Socket> callers;
  for (int i = 0; i < 3; ++i) {
    callers.emplace_back(io.get_executor());
    callers.back().connect({asio::ip::address_v4::loopback(), accepting.port()});
  }
  ::testing::internal::CaptureStderr();
  run_events(io, "welcome failed", [&] { accepting.ensure(); });
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("welcome failed"));
  EXPECT_EQ(welcomed.size(), 2u);
}

TEST(AcceptLoop, WhoComesTogetherIsWelcomedBeforeOtherWorkIsDone) {
  asio::io_context io{1};
  std::size_t welcomed = 0;
  AcceptLoop accepting(io, "accept failed", [&](const Socket&) { ++welcomed; });
  ASSERT_TRUE(accepting.listen({"127.0.0.1", 0, "test.port"}));
  std::vector<Socket> callers;
  for (int i = 0; i < 5; ++i) {
    callers.emplace_back(io.get_executor());
    callers.back().connect({asio::ip::address_v4::loopback(), accepting.port()});
  }
  accepting.ensure();
  while (welcomed == 0) io.run_one();
  std::size_t before_other_work = 0;
  asio::post(io, [&] { before_other_work = welcomed; });
  io.poll();
  EXPECT_EQ(before_other_work, callers.size());
}

TEST(AcceptLoop, ATakenPortNamesTheKeyToChange) {
  asio::io_context io{1};
  AcceptLoop first(io, "accept failed", [](Socket) {});
  ASSERT_TRUE(first.listen({"127.0.0.1", 0, "test.port"}));
  AcceptLoop second(io, "accept failed", [](Socket) {});
  const auto listening = second.listen({"127.0.0.1", first.port(), "test.port"});
  ASSERT_FALSE(listening);
  EXPECT_THAT(to_string(listening.error()), HasSubstr(std::to_string(first.port())));
  EXPECT_THAT(to_string(listening.error()), HasSubstr("set test.port to"));
}

TEST(Every, GoesOnAfterItsWorkHasThrown) {
  asio::io_context io{1};
  int done = 0;
  Every sweeping(io, 1ms, [&] {
    if (++done == 3) return sweeping.stop();
    throw std::bad_alloc();
  });
  ::testing::internal::CaptureStderr();
  run_events(io, "sweep failed", [&] { sweeping.ensure(); });
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("sweep failed"));
  EXPECT_EQ(done, 3);
}

TEST(Every, StopsAtOnce) {
  asio::io_context io{1};
  int done = 0;
  Every sweeping(io, 1h, [&] { ++done; });
  asio::post(io, [&] { sweeping.stop(); });
  run_events(io, "sweep failed", [&] { sweeping.ensure(); });
  EXPECT_EQ(done, 0);
}

}  // namespace
}  // namespace chorus::net
