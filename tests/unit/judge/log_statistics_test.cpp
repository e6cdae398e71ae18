#include "tests/judge/log_statistics.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

namespace chorus::bench {
namespace {

using enum JointId;
constexpr Duration kFrame = std::chrono::milliseconds(33);

/// A body at rest: SpineMid and Neck are 0.2 m and 0.6 m above SpineBase.
SensorFrame still(std::int64_t number) {
  SensorFrame frame;
  frame.captured = Timestamp(kFrame * number);
  BodyFrame body{BodyId{1}, frame.captured, {}};
  double height = 0.0;
  for (const JointId id : {SpineBase, SpineMid, SpineShoulder, Neck}) {
    body.skeleton[id].position = {0, height, 2};
    body.skeleton[id].state = JointState::Tracked;
    height += 0.2;
  }
  frame.bodies.push_back(body);
  return frame;
}

TEST(LogStatistics, FindsTheWhiteNoiseThatWasPutInAlsoInAMovingBody) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<SensorFrame> frames;
  for (int i = 0; i < 4000; ++i) {
    frames.push_back(still(i));
    auto& neck = frames.back().bodies[0].skeleton[Neck].position;
    neck += Eigen::Vector3d(0.002 * normal(random), 0.003 * normal(random), 0.005 * normal(random));
    neck.x() += std::sin(i * 0.033);  // moving, smoothly
  }
  const LogStatistics s = statistics_of(frames);
  EXPECT_NEAR(s.white[index_of(Neck)].x(), 0.002, 0.0001);
  EXPECT_NEAR(s.white[index_of(Neck)].y(), 0.003, 0.00015);
  EXPECT_NEAR(s.white[index_of(Neck)].z(), 0.005, 0.00025);
  EXPECT_NEAR(s.white[index_of(SpineBase)].x(), 0.0, 1e-9);
  EXPECT_EQ(s.frames, 4000u);
}

TEST(LogStatistics, FindsBoneLengthVariationAndItsCorrelation) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::vector<SensorFrame> frames;
  double state = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    state = 0.9 * state + std::sqrt(1 - 0.81) * normal(random);
    frames.push_back(still(i));
    frames.back().bodies[0].skeleton[SpineMid].position.y() += 0.02 * state;
  }
  const LogStatistics s = statistics_of(frames);
  EXPECT_NEAR(s.bone_std.at(SpineMid), 0.02, 0.001);
  EXPECT_NEAR(s.lag_frame.at(SpineMid), 0.9, 0.02);
  EXPECT_NEAR(s.lag_third.at(SpineMid), std::pow(0.9, 10), 0.06);
}

TEST(LogStatistics, CountsInferredOfTheSeenOnly) {
  std::vector<SensorFrame> frames;
  for (int i = 0; i < 100; ++i) {
    frames.push_back(still(i));
    auto& neck = frames.back().bodies[0].skeleton[Neck];
    if (i < 20) neck.state = JointState::Inferred;
    if (i >= 80) neck = Joint{};
  }
  const LogStatistics s = statistics_of(frames);
  EXPECT_DOUBLE_EQ(s.inferred_share[index_of(Neck)], 0.25);
  EXPECT_TRUE(std::isnan(s.inferred_share[index_of(Head)])) << "never seen";
}

TEST(LogStatistics, TellsTheNoiseOfGuessesFromThatOfTrackedJoints) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<SensorFrame> frames;
  for (int i = 0; i < 6000; ++i) {
    frames.push_back(still(i));
    Joint& neck = frames.back().bodies[0].skeleton[Neck];
    const bool guessed = i / 100 % 2 == 1;
    if (guessed) neck.state = JointState::Inferred;
    neck.position.x() += (guessed ? 0.02 : 0.004) * normal(random);
  }
  const LogStatistics s = statistics_of(frames);
  EXPECT_NEAR(s.white[index_of(Neck)].x(), 0.004, 0.0003);
  EXPECT_NEAR(s.white_inferred[index_of(Neck)].x(), 0.02, 0.0015);
  EXPECT_TRUE(std::isnan(s.white_inferred[index_of(SpineMid)].x())) << "never guessed";
}

TEST(LogStatistics, KnowsThePaceTheLongestGapAndWhatHasNoOrientation) {
  std::vector<SensorFrame> frames;
  for (int i = 0; i < 100; ++i) {
    frames.push_back(still(i < 50 ? i : i + 30));
    frames.back().bodies[0].skeleton[Neck].orientation = Eigen::Quaterniond::Identity();
  }
  const LogStatistics s = statistics_of(frames);
  EXPECT_NEAR(s.steps[0], 0.033, 1e-9);
  EXPECT_NEAR(s.steps[1], 0.033, 1e-9);
  EXPECT_NEAR(s.steps[2], 31 * 0.033, 1e-9);
  EXPECT_EQ(s.unoriented, kJointCount - 1);
}

TEST(LogStatistics, GapsAndEmptyLogsAreSurvived) {
  std::vector<SensorFrame> frames;
  for (int i = 0; i < 60; ++i) {
    // Every third step is a gap, so there are no four successive frames: nothing to measure.
    frames.push_back(still(i + 10 * (i / 3)));
  }
  EXPECT_TRUE(std::isnan(statistics_of(frames).white[index_of(Neck)].x()));
  EXPECT_EQ(statistics_of({}).frames, 0u);
  EXPECT_TRUE(std::isnan(deviation({1.0})));
  EXPECT_TRUE(std::isnan(autocorrelation({1.0, 2.0}, 1)));
}

}  // namespace
}  // namespace chorus::bench
