// What the server answers for instants of seconds ago when it smooths.
#include <deque>
#include <utility>

#include <gtest/gtest.h>

#include "fusion-server/core/fusion_core.h"
#include "tests/unit/core/ring_of_three.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using testing::kStart;
using testing::sensor_id;

constexpr Duration kLength = std::chrono::seconds(6);

struct LiveAndSmoothed {
  std::vector<Snapshot> live;
  std::vector<Snapshot> smoothed;
};

/// Runs a core for six seconds; every third frame of the last sensor comes 0.4 s late.
LiveAndSmoothed answers(CoreConfig config) {
  FusionCore core(std::move(config), ring());
  std::deque<std::pair<Duration, SensorFrame>> on_the_way;
  LiveAndSmoothed all;
  for (Duration t{0}; t < kLength; t += milliseconds(1)) {
    for (int i = 0; i < kSensors; ++i) {
      if ((t - milliseconds(7 * i)) % milliseconds(33) != Duration{0}) continue;
      SensorFrame frame = sight(i, t);
      frame.sequence = static_cast<std::uint64_t>(t / milliseconds(33));
      const bool late = i == kSensors - 1 && frame.sequence % 30 < 10;
      frame.received = kStart + t + milliseconds(late ? 400 : 2);
      on_the_way.emplace_back(frame.received - kStart, std::move(frame));
    }
    for (auto it = on_the_way.begin(); it != on_the_way.end();) {
      if (it->first > t) {
        ++it;
        continue;
      }
      core.take(std::move(it->second));
      it = on_the_way.erase(it);
    }
    while (auto snapshot = core.tick(kStart + t)) {
      all.live.push_back(std::move(*snapshot));
      (void)core.amended(kStart + t);
      for (Snapshot& each : core.smoothed()) all.smoothed.push_back(std::move(each));
    }
  }
  return all;
}

CoreConfig smoothing() {
  CoreConfig config = of_three<CoreConfig>();
  config.pipeline.smoothing = {true, milliseconds(1500), milliseconds(500)};
  return config;
}

TEST(SmoothedAnswers, AreGivenOnceForEveryInstantAfterTheDelay) {
  const LiveAndSmoothed all = answers(smoothing());
  ASSERT_GT(all.smoothed.size(), 100u);
  EXPECT_NEAR(static_cast<double>(all.live.size() - all.smoothed.size()), 60.0, 2.0);
  for (std::size_t i = 0; i < all.smoothed.size(); ++i) {
    EXPECT_EQ(all.smoothed[i].sequence, all.live[i].sequence);
    for (const FusedBody& body : all.smoothed[i].bodies) {
      EXPECT_EQ(body.id, all.live.back().bodies.at(0).id);
      EXPECT_NEAR(body.smoothed_over.value_or(0), 2.0, 0.04);
    }
  }
}

TEST(SmoothedAnswers, IncludeFramesThatCameTooLateForTheFirstAnswer) {
  const LiveAndSmoothed all = answers(smoothing());
  const auto complete = [](const std::vector<Snapshot>& snapshots, std::size_t count) {
    std::size_t found = 0;
    for (std::size_t i = 30; i < count; ++i) {
      if (snapshots[i].bodies.empty()) continue;
      found += snapshots[i].bodies[0].contributors[index_of(JointId::Neck)] == 0b111U ? 1U : 0U;
    }
    return static_cast<double>(found) / static_cast<double>(count - 30);
  };
  EXPECT_LT(complete(all.live, all.smoothed.size()), 0.8);
  EXPECT_GT(complete(all.smoothed, all.smoothed.size()), 0.95);
}

TEST(SmoothedAnswers, AreNotLostWhenPlacesChangeBeforeTheyAreFetched) {
  FusionCore core(smoothing(), ring());
  std::size_t ticks = 0;
  for (Duration t{0}; t < std::chrono::seconds(3); t += milliseconds(11)) {
    for (int i = 0; i < kSensors; ++i) core.take(sight(i, t));
    while (core.tick(kStart + t)) ++ticks;
  }
  ASSERT_TRUE(core.register_anew(sensor_id("s3")));
  ASSERT_FALSE(core.registration().sensors.contains(sensor_id("s3")));
  const auto smoothed = core.smoothed();
  EXPECT_NEAR(static_cast<double>(ticks - smoothed.size()), 60.0, 2.0);
  EXPECT_TRUE(core.smoothed().empty()) << "each once";
}

TEST(SmoothedAnswers, ChangeNothingThatIsAnsweredAtOnce) {
  const LiveAndSmoothed with = answers(smoothing());
  const LiveAndSmoothed without = answers(of_three<CoreConfig>());
  EXPECT_TRUE(without.smoothed.empty());
  ASSERT_EQ(with.live.size(), without.live.size());
  for (std::size_t i = 0; i < with.live.size(); ++i) {
    ASSERT_EQ(with.live[i].bodies.size(), without.live[i].bodies.size());
    for (std::size_t k = 0; k < with.live[i].bodies.size(); ++k) {
      const FusedBody& one = with.live[i].bodies[k];
      EXPECT_EQ(one.variance, without.live[i].bodies[k].variance);
      EXPECT_FALSE(one.smoothed_over);
    }
  }
}

}  // namespace
}  // namespace chorus::core
