// What keeps a server accepting, whatever its handlers throw.
#include "common/http/listen.h"

#include <new>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/http/event_loop.h"
#include "common/http/every.h"
#include "tests/integration/http/raw_client.h"
#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using ::testing::HasSubstr;
using namespace std::chrono_literals;

TEST(AcceptLoop, WhatAConnectionsWelcomeThrowsCostsThatOneAlone) {
  net::io_context io{1};
  std::vector<Socket> welcomed;
  int came = 0;
  AcceptLoop accepting(io, "accept failed", [&](Socket socket) {
    if (++came == 1) throw std::bad_alloc();
    welcomed.push_back(std::move(socket));
    if (came == 3) accepting.stop();
  });
  ASSERT_TRUE(accepting.listen({"127.0.0.1", 0, "test.port"}));
  RawClient first(accepting.port());
  RawClient second(accepting.port());
  RawClient third(accepting.port());
  ::testing::internal::CaptureStderr();
  run_events(io, "welcome failed", [&] { accepting.ensure(); });
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("welcome failed"));
  EXPECT_EQ(welcomed.size(), 2u);
}

TEST(AcceptLoop, ATakenPortNamesTheKeyToChange) {
  const TestServer first;
  ServerConfig same;
  same.port = first.server.port();
  Server second(same, std::make_shared<Router>());
  const auto started = second.start();
  ASSERT_FALSE(started);
  EXPECT_THAT(to_string(started.error()), HasSubstr(std::to_string(same.port)));
  EXPECT_THAT(to_string(started.error()), HasSubstr("set http.port to"));
}

TEST(Every, GoesOnAfterItsWorkHasThrown) {
  net::io_context io{1};
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
  net::io_context io{1};
  int done = 0;
  Every sweeping(io, 1h, [&] { ++done; });
  net::post(io, [&] { sweeping.stop(); });
  run_events(io, "sweep failed", [&] { sweeping.ensure(); });
  EXPECT_EQ(done, 0);
}

}  // namespace
}  // namespace chorus::http::test
