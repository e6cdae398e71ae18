#include "fusion-server/facing/walking.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/facing/posed_body.h"

namespace chorus::facing {
namespace {

constexpr Timestamp kWalkStart = from_unix_ns(1'790'000'000'000'000'000);
constexpr Duration kWalkFrame = std::chrono::milliseconds(33);
const Eigen::Vector3d kWalkAhead = Eigen::Vector3d::UnitZ();

TEST(Walk, SpeaksForTheWayThatIsWalkedInProportionToSpeed) {
  const WalkingCue cue;
  double before = 0.0;
  for (const double speed : {0.5, 0.8, 1.2}) {
    Walk walk;
    for (int i = 0; i < 60; ++i)
      walk.follow({view_from(1, 0, body_at({0, 0, speed * 0.033 * i}, 0))},
                  kWalkStart + i * kWalkFrame, cue);
    const double odds = walk.log_odds(kWalkAhead, cue);
    EXPECT_GT(odds, before);
    EXPECT_NEAR(walk.log_odds(-kWalkAhead, cue), -odds, 1e-12);
    EXPECT_NEAR(walk.log_odds(Eigen::Vector3d::UnitX(), cue), 0.0, 1e-9);
    before = odds;
  }
  EXPECT_NEAR(before, cue.log_odds, 1e-9);
}

TEST(Walk, IsNotFakedByAViewThatComesAndGoes) {
  Walk walk;
  for (int i = 0; i < 60; ++i) {
    std::vector<SensorView> views{view_from(1, 0, body_at({0, 0, 0}, 0))};
    if (i % 4 < 2) views.push_back(view_from(2, 0, body_at({0, 0, 0.2}, 0)));
    walk.follow(views, kWalkStart + i * kWalkFrame, {});
    EXPECT_EQ(walk.log_odds(kWalkAhead, {}), 0.0) << i;
  }
}

TEST(Walk, IsSeenAlsoWhenSensorsAnswerInTurn) {
  Walk walk;
  for (int i = 0; i < 120; ++i)
    walk.follow({view_from(i % 2, 0, body_at({0, 0, 0.0165 * i}, 0))},
                kWalkStart + i * kWalkFrame / 2, {});
  EXPECT_GT(walk.log_odds(kWalkAhead, {}), 2.0);
}

/// Log odds at the end of two seconds of moving ahead at 1.2 m/s, while the trunk goes up and down.
double odds_of_bobbing(double height, double hz) {
  Walk walk;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.033 * i;
    const double up = height * std::abs(std::sin(std::numbers::pi * hz * t));
    walk.follow({view_from(1, 0, body_at({0, up, 1.2 * t}, 0))}, kWalkStart + i * kWalkFrame, {});
  }
  return walk.log_odds(kWalkAhead, {});
}

TEST(Walk, IsNoJumping) {
  EXPECT_NEAR(odds_of_bobbing(0.05, 2.0), WalkingCue{}.log_odds, 0.01);
  EXPECT_EQ(odds_of_bobbing(0.5, 1.6), 0.0);
}

TEST(Walk, OfNobodyIsNone) {
  Walk walk;
  walk.follow({}, kWalkStart, {});
  walk.follow({view_from(1, 0, {})}, kWalkStart + kWalkFrame, {});
  EXPECT_EQ(walk.log_odds(kWalkAhead, {}), 0.0);
}

}  // namespace
}  // namespace chorus::facing
