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

Shares shares_of(double first, double second) {
  ShareTally tally;
  tally.add(0b01, first);
  tally.add(0b10, second);
  return tally.shares();
}

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
  body.smoothed_over = 2.5;
  body.skeleton = testing::standing_person({x, 0, 0});
  body.variance.fill(1e-4);
  body.contributors.fill(0b11);
  body.shares.fill(shares_of(0.8, 0.2));
  body.contributors[index_of(JointId::HandLeft)] = 0;
  body.shares[index_of(JointId::HandLeft)] = {};
  body.age[index_of(JointId::HandLeft)] = 0.1;
  testing::hide(body.skeleton[JointId::FootLeft]);
  s.bodies.push_back(body);
  return s;
}

TEST(SnapshotResource, HasTheHandsAndWhatTheyHold) {
  Snapshot s = snapshot(42, 0.5);
  EXPECT_FALSE(to_resource(s).bodies[0].left_hand);
  HandPoints hand;
  hand.points[20] = {1.0, 2.0, 3.0};
  hand.variance = 0.01;
  s.bodies[0].hands = shared({std::nullopt, hand});
  HeldThing box{"box", PersonId{7}, {JointId::HandRight}};
  box.world_from_thing.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  box.sigma = 0.02;
  box.turn_sigma = 0.5;
  s.held = {box, {"driver", PersonId{7}, {}}};
  const auto frame = to_resource(s);
  EXPECT_FALSE(frame.bodies[0].left_hand);
  ASSERT_TRUE(frame.bodies[0].right_hand);
  EXPECT_EQ(frame.bodies[0].right_hand->points[20], Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(frame.bodies[0].right_hand->variance, 0.01);
  ASSERT_EQ(frame.props.size(), 2u);
  EXPECT_EQ(frame.props[0].position, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(frame.props[0].place_sigma, 0.02);
  EXPECT_NEAR(frame.props[0].turn_sigma_degrees.value(), 28.648, 1e-3);
  EXPECT_FALSE(frame.props[1].place_sigma) << "not known";
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
  EXPECT_EQ(frame.bodies[0].smoothed_over, 2.5);
  const auto& neck = frame.bodies[0].joints[index_of(JointId::Neck)];
  EXPECT_EQ(neck.contributors, 0b11u);
  EXPECT_EQ(neck.variance, 1e-4);
  EXPECT_EQ(neck.shares.of(0), 0.8);
  EXPECT_EQ(neck.shares.of(1), 0.2);
  EXPECT_FALSE(neck.age) << "sensors see it now";
  EXPECT_EQ(frame.bodies[0].joints[index_of(JointId::HandLeft)].age, 0.1);
  const auto& foot = frame.bodies[0].joints[index_of(JointId::FootLeft)];
  EXPECT_FALSE(foot.variance);
  EXPECT_EQ(foot.contributors, 0u);
}

TEST(SnapshotResource, SaysHowJointsAndBodiesMove) {
  Snapshot s = snapshot(42, 0.5);
  EXPECT_FALSE(to_resource(s).bodies[0].velocity) << "the method knows of no motion";
  s.bodies[0].motion.emplace();
  for (const JointId id : {JointId::Head, JointId::SpineBase, JointId::HandRight})
    (*s.bodies[0].motion)[index_of(id)].variance = 0.01;
  (*s.bodies[0].motion)[index_of(JointId::Head)].velocity = {2.0, 0.0, 0.0};
  (*s.bodies[0].motion)[index_of(JointId::SpineBase)].velocity = {1.0, 0.0, 0.0};
  (*s.bodies[0].motion)[index_of(JointId::HandRight)].velocity = {9.0, 0.0, 0.0};
  const auto frame = to_resource(s);
  const auto& joints = frame.bodies[0].joints;
  EXPECT_EQ(joints[index_of(JointId::Head)].velocity, Eigen::Vector3d(2.0, 0.0, 0.0));
  EXPECT_EQ(joints[index_of(JointId::Head)].velocity_variance, 0.01);
  EXPECT_FALSE(joints[index_of(JointId::Neck)].velocity) << "no filter knows it";
  EXPECT_EQ(frame.bodies[0].velocity, Eigen::Vector3d(1.5, 0.0, 0.0)) << "hands are not the trunk";
  EXPECT_EQ(frame.bodies[0].velocity_variance, 0.01);
}

TEST(SnapshotResource, SaysByWhichMethodAndInWhichWorld) {
  Snapshot s = snapshot(42, 0.5);
  EXPECT_FALSE(to_resource(s).registration_version) << "no registration";
  EXPECT_FALSE(to_resource(s).bodies[0].method);
  s.registration_version = 5;
  s.bodies[0].method = "body-filter";
  EXPECT_EQ(to_resource(s).registration_version, 5u);
  EXPECT_EQ(to_resource(s).bodies[0].method, "body-filter");
}

TEST(SnapshotResource, SaysHowThePersonIsBuilt) {
  Snapshot s = snapshot(42, 0.5);
  s.bodies[0].stature = LearnedLength{1.78, 0.07};
  s.bodies[0].bones.emplace();
  (*s.bodies[0].bones)[index_of(JointId::KneeLeft)] = {0.43, 0.004};
  (*s.bodies[0].bones)[index_of(JointId::FootLeft)] = {0.12, 0.004};
  const auto body = to_resource(s).bodies[0];
  EXPECT_EQ(body.stature, 1.78);
  EXPECT_EQ(body.stature_sigma, 0.07);
  EXPECT_EQ(body.joints[index_of(JointId::KneeLeft)].bone_length, 0.43);
  EXPECT_EQ(body.joints[index_of(JointId::KneeLeft)].bone_sigma, 0.004);
  EXPECT_FALSE(body.joints[index_of(JointId::AnkleLeft)].bone_length) << "not learned";
  EXPECT_FALSE(body.joints[index_of(JointId::FootLeft)].bone_length) << "not tracked now";
}

TEST(SnapshotResource, IsValidInputForAnotherFusionServer) {
  const auto frame = to_resource(snapshot(42, 0.5));
  const auto read = read_frame(write(frame, resource::Format::Turtle), resource::Format::Turtle);
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->bodies.size(), 1u);
  EXPECT_EQ(read->bodies[0].slot, 3u);
  EXPECT_EQ(read->bodies[0].sides_confidence, 0.875);
  const auto& neck = read->bodies[0].joints[index_of(JointId::Neck)];
  EXPECT_EQ(neck.shares, shares_of(0.8, 0.2));
  EXPECT_EQ(read->bodies[0].joints[index_of(JointId::HandLeft)].age, 0.1);
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

TEST(Between, SharesAreInBetweenAndAJointThatNobodySeesGetsOlder) {
  const auto a = to_resource(snapshot(1, 0.0));
  auto b = to_resource(snapshot(2, 0.1));
  b.bodies[0].joints[index_of(JointId::Neck)].shares = shares_of(0.4, 0.6);
  b.bodies[0].joints[index_of(JointId::Head)].shares = {};
  b.bodies[0].joints[index_of(JointId::HandLeft)].age = 0.1 + seconds(kFrameInterval);
  const auto mid = resource::between(a, b, a.captured + kFrameInterval / 4);
  const auto& joints = mid.bodies.at(0).joints;
  EXPECT_NEAR(joints[index_of(JointId::Neck)].shares.of(0), 0.7, 1e-9);
  EXPECT_FALSE(joints[index_of(JointId::Head)].shares.known()) << "b does not say";
  EXPECT_NEAR(joints[index_of(JointId::HandLeft)].age.value(), 0.1 + seconds(kFrameInterval) / 4,
              1e-9);
}

TEST(SnapshotResource, NamesInertialSourcesBehindTheSensors) {
  Snapshot s = snapshot(1, 0.0);
  FusedBody& body = s.bodies.front();
  const std::size_t wrist = index_of(JointId::WristLeft);
  const std::size_t hand = index_of(JointId::HandLeft);
  body.worn_sources = {sensor_id("suit")};
  body.worn_contributors[wrist] = body.worn_contributors[hand] = 1;
  body.worn_share[wrist] = 0.5;
  body.worn_share[hand] = 1.0;
  const auto frame = to_resource(s);
  EXPECT_EQ(frame.sensors, (std::vector<std::string>{"s1", "s2", "suit"}));
  const auto& joints = frame.bodies.at(0).joints;
  EXPECT_EQ(joints[wrist].contributors, 0b111u);
  EXPECT_DOUBLE_EQ(joints[wrist].shares.of(0), 0.4);
  EXPECT_DOUBLE_EQ(joints[wrist].shares.of(2), 0.5);
  EXPECT_EQ(joints[hand].contributors, 0b100u);
  ASSERT_TRUE(joints[hand].age) << "no sensor sees it";
  EXPECT_EQ(joints[index_of(JointId::Neck)].contributors, 0b11u);
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
