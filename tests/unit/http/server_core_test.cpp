// Which clients a publication wakes, without a socket.
#include "common/http/server_core.h"

#include <array>
#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

class Sleeper final : public Connection {
 public:
  Sleeper() : Connection("192.0.2.1") {}
  void wake() override {
    ++woken;
    if (on_wake) on_wake();
  }
  void expire() override {}
  void stop() override {}
  void close() override {}
  int woken = 0;
  std::function<void()> on_wake = {};
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

/// What two readers are woken for if version 2 comes while they are woken for version 1.
std::array<std::string, 2> shown_to_two(ServerCore& core, LiveDocument& live) {
  std::array<std::shared_ptr<Sleeper>, 2> sleepers{std::make_shared<Sleeper>(),
                                                   std::make_shared<Sleeper>()};
  std::array<std::string, 2> shown;
  for (std::size_t i = 0; i < sleepers.size(); ++i) {
    sleepers[i]->on_wake = [&, i] {
      const DocumentPtr document = core.woken_for(0);
      shown[i] += document ? document->options().version : "none";
      core.wait_for(0, sleepers[i]);
      if (shown[0] == "1") live.publish(make_document("text/plain", "x", {"2"}));
    };
    core.wait_for(0, sleepers[i]);
  }
  live.publish(make_document("text/plain", "x", {"1"}));
  core.io.restart();
  core.io.poll();
  for (const auto& sleeper : sleepers) core.stop_waiting(0, sleeper.get());
  return shown;
}

TEST_F(Waking, AllAreWokenForTheSameVersions) {
  core_->stale_after = std::chrono::hours(1);
  EXPECT_EQ(shown_to_two(*core_, *live_), (std::array<std::string, 2>{"12", "12"}));
  EXPECT_EQ(core_->woken_for(0), nullptr) << "only while they are woken";
}

TEST_F(Waking, IfThatTakesTooLongTheRestGetTheNewestVersion) {
  core_->stale_after = SteadyTime::duration{0};
  EXPECT_EQ(shown_to_two(*core_, *live_), (std::array<std::string, 2>{"12", "22"}));
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
