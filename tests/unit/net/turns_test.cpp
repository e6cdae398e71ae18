#include "common/net/turns.h"

#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::net {
namespace {

using ::testing::ElementsAre;

TEST(Turns, WhatIsReadyGoesBetweenTwoTasks) {
  asio::io_context io{1};
  Turns turns(io);
  std::vector<int> ran;
  for (const int task : {1, 2, 3}) turns.take([&ran, task] { ran.push_back(task); });
  asio::post(io, [&ran] { ran.push_back(10); });
  io.run();
  EXPECT_THAT(ran, ElementsAre(1, 10, 2, 3));
}

TEST(Turns, ATaskThatThrowsDoesNotEndTheSeriesAndTasksMayAskForMore) {
  asio::io_context io{1};
  Turns turns(io);
  std::vector<int> ran;
  turns.take([] { throw std::runtime_error("broken"); });
  turns.take([&] {
    ran.push_back(1);
    turns.take([&ran] { ran.push_back(2); });
    EXPECT_THAT(ran, ElementsAre(1)) << "never at once";
  });
  EXPECT_THROW(io.run(), std::runtime_error);
  io.run();
  EXPECT_THAT(ran, ElementsAre(1, 2));
}

}  // namespace
}  // namespace chorus::net
