// A snapshot on the wire.
#include "fusion-server/wire/snapshot_resource.h"

#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "common/resource/frame_between.h"
#include "tests/support/builders.h"

namespace chorus::wire {
namespace {

using testing::kFrameInterval;
using testing::kStart;
using testing::sensor_id;

Snapshot snapshot(std::uint64_t sequence, double x) {
  Snapshot s;
  s.sequence = sequence;
  s.instant = kStart + kFrameInterval * static_cast<int>(sequence);
  s.sensors = {sensor_id("s1"), sensor_id("s2")};
  FusedBody body;
  body.id = {7};
  body.slot = 3;
  body.sides_confidence = 0.875;
  body.carried_for = 0.25;
  body.skeleton = testing::standing_person({x, 0, 0});
  body.variance.fill(1e-4);
  body.contributors.fill(0b11);
  testing::hide(body.skeleton[JointId::FootLeft]);
  s.bodies.push_back(body);
  return s;
}

TEST(SnapshotResource, SaysWorldSpaceSensorsAndContributors) {
  const auto frame = to_resource(snapshot(42, 0.5));
  EXPECT_EQ(frame.sequence, 42u);
  EXPECT_EQ(frame.source, "fusion");
  EXPECT_EQ(frame.space, resource::SpaceKind::World);
  EXPECT_EQ(frame.sensors, (std::vector<std::string>{"s1", "s2"}));
  ASSERT_EQ(frame.bodies.size(), 1u);
  EXPECT_EQ(frame.bodies[0].slot, 3u);
  EXPECT_EQ(frame.bodies[0].sides_confidence, 0.875);
  EXPECT_EQ(frame.bodies[0].carried_for, 0.25);
  const auto& neck = frame.bodies[0].joints[index_of(JointId::Neck)];
  EXPECT_EQ(neck.contributors, 0b11u);
  EXPECT_EQ(neck.variance, 1e-4);
  const auto& foot = frame.bodies[0].joints[index_of(JointId::FootLeft)];
  EXPECT_FALSE(foot.variance);
  EXPECT_EQ(foot.contributors, 0u);
}

TEST(SnapshotResource, IsValidInputForAnotherFusionServer) {
  const auto frame = to_resource(snapshot(42, 0.5));
  const auto read = read_frame(write(frame, resource::Format::Turtle), resource::Format::Turtle);
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->bodies.size(), 1u);
  EXPECT_EQ(read->bodies[0].slot, 3u);
  EXPECT_EQ(read->bodies[0].sides_confidence, 0.875);
}

TEST(SnapshotResource, MoreBodiesThanAFrameMayHoldAreCut) {
  Snapshot crowd = snapshot(1, 0);
  crowd.bodies.resize(kMaxBodies + 10, crowd.bodies[0]);
  EXPECT_EQ(to_resource(crowd).bodies.size(), kMaxBodies);
}

TEST(Between, InterpolatesPositionsAndTakesTheWorseState) {
  const auto a = to_resource(snapshot(1, 0.0));
  auto b = to_resource(snapshot(2, 0.1));
  b.bodies[0].joints[index_of(JointId::Head)].state = JointState::Inferred;
  b.bodies[0].joints[index_of(JointId::Neck)].variance = 4e-4;
  const auto mid = resource::between(a, b, a.captured + kFrameInterval / 4);
  EXPECT_EQ(mid.captured, a.captured + kFrameInterval / 4);
  const auto& neck = mid.bodies.at(0).joints[index_of(JointId::Neck)];
  EXPECT_NEAR(neck.position.x(), 0.025, 1e-6);
  EXPECT_EQ(neck.variance, 4e-4);
  EXPECT_EQ(mid.bodies[0].joints[index_of(JointId::Head)].state, JointState::Inferred);
  EXPECT_EQ(mid.bodies[0].joints[index_of(JointId::FootLeft)].state, JointState::NotTracked);
}

TEST(Between, LeavesOutBodiesThatOnlyOneOfThemHas) {
  const auto a = to_resource(snapshot(1, 0.0));
  auto b = to_resource(snapshot(2, 0.1));
  b.bodies[0].id = 8;
  EXPECT_TRUE(resource::between(a, b, a.captured + kFrameInterval / 2).bodies.empty());
}

TEST(Between, DoesNotMixFramesOfDifferentCirclesOrEqualTimes) {
  const auto a = to_resource(snapshot(1, 0.0));
  auto b = to_resource(snapshot(2, 0.1));
  b.sensors = {"s9"};
  EXPECT_EQ(resource::between(a, b, a.captured + kFrameInterval / 2).captured, a.captured);
  EXPECT_EQ(resource::between(a, a, a.captured).captured, a.captured);
}

}  // namespace
}  // namespace chorus::wire
