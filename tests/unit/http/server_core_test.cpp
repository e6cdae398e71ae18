// Which clients a publication wakes, without a socket.
#include "common/http/server_core.h"

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

class Sleeper final : public Connection {
 public:
  Sleeper() : Connection("192.0.2.1") {}
  void wake() override { ++woken; }
  void expire() override {}
  void stop() override {}
  void close() override {}
  int woken = 0;
};

class Waking : public ::testing::Test {
 protected:
  Waking() {
    auto router = std::make_shared<Router>();
    router->live("/frame", live_);
    core_ = std::make_shared<ServerCore>(ServerConfig{}, router);
    core_->subscribe();
  }
  /// Number of handlers that a publication runs on the server's thread.
  std::size_t publish() {
    live_->publish(make_document("text/plain", "x", {"1"}));
    core_->io.restart();
    return core_->io.poll();
  }

  std::shared_ptr<LiveDocument> live_ = std::make_shared<LiveDocument>();
  std::shared_ptr<ServerCore> core_;
};

TEST_F(Waking, APublishThatNobodyWaitsForLeavesTheServerAsleep) { EXPECT_EQ(publish(), 0u); }

TEST_F(Waking, WhoWaitsIsWokenOnceAndHasToWaitAgain) {
  const auto sleeper = std::make_shared<Sleeper>();
  core_->wait_for(0, sleeper);
  EXPECT_EQ(publish(), 1u);
  EXPECT_EQ(sleeper->woken, 1);
  EXPECT_EQ(publish(), 0u);
  core_->wait_for(0, sleeper);
  EXPECT_EQ(publish(), 1u);
  EXPECT_EQ(sleeper->woken, 2);
}

TEST_F(Waking, WhoHasLeftIsNotWaitedFor) {
  const auto sleeper = std::make_shared<Sleeper>();
  core_->wait_for(0, sleeper);
  core_->stop_waiting(0, sleeper.get());
  EXPECT_EQ(publish(), 0u);
  EXPECT_EQ(sleeper->woken, 0);
}

}  // namespace
}  // namespace chorus::http
