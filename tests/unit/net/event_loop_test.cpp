#include "common/net/event_loop.h"

#include <new>

#include <gtest/gtest.h>

namespace chorus::net {
namespace {

TEST(RunEvents, WhatAHandlerThrowsIsLoggedAndTheOthersStillRun) {
  asio::io_context io{1};
  int ran = 0;
  asio::post(io, [] { throw std::bad_alloc(); });
  asio::post(io, [&ran] { ++ran; });
  ::testing::internal::CaptureStderr();
  run_events(io, "a server's handler failed");
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(ran, 1);
  EXPECT_NE(said.find("a server's handler failed what="), std::string::npos) << said;
}

TEST(RunEvents, WhatMustBeUnderWayIsStartedAgain) {
  asio::io_context io{1};
  int prepared = 0;
  int ran = 0;
  ::testing::internal::CaptureStderr();
  run_events(io, "failed", [&] {
    const bool first = ++prepared == 1;
    asio::post(io, [&ran, first] {  // The only work, so that nothing else keeps the loop running.
      if (first) throw std::bad_alloc();
      ++ran;
    });
  });
  (void)::testing::internal::GetCapturedStderr();
  EXPECT_EQ(prepared, 2);
  EXPECT_EQ(ran, 1);
}

}  // namespace
}  // namespace chorus::net
