// What `/frame?at=` answers for an instant between two frames.
#include "common/resource/frame_between.h"

#include <gtest/gtest.h>

#include "common/body/bones.h"

namespace chorus::resource {
namespace {

using std::chrono::milliseconds;

constexpr Timestamp kFirst = from_unix_ns(1'795'246'200'000'000'000);

JointResource& joint_of(FrameResource& frame, JointId id = JointId::Head) {
  return frame.bodies.at(0).joints[index_of(id)];
}
const JointResource& joint_of(const FrameResource& frame, JointId id = JointId::Head) {
  return frame.bodies.at(0).joints[index_of(id)];
}

/// A fused frame of one body whose head is at x.
FrameResource frame_at(milliseconds after, double x) {
  FrameResource frame;
  frame.sequence = static_cast<std::uint64_t>(after.count());
  frame.captured = kFirst + after;
  frame.source = "fusion";
  frame.space = SpaceKind::World;
  frame.sensors = {"s1", "s2", "s3"};
  BodyResource& body = frame.bodies.emplace_back();
  body.id = 3;
  body.captured = frame.captured;
  JointResource& head = joint_of(frame);
  head.state = JointState::Tracked;
  head.position = {x, 1.7, 2.0};
  return frame;
}

Shares shared(double first, double second) {
  ShareTally tally;
  tally.add(1, first);
  tally.add(2, second);
  return tally.shares();
}

/// At 10 ms of two frames 40 ms apart: a quarter of the way.
FrameResource quarter(const FrameResource& a, const FrameResource& b) {
  return between(a, b, kFirst + milliseconds(10));
}

TEST(FrameBetween, IsProportionalToTime) {
  const FrameResource mixed =
      quarter(frame_at(milliseconds(0), 1.0), frame_at(milliseconds(40), 3.0));
  EXPECT_EQ(mixed.captured, kFirst + milliseconds(10));
  EXPECT_EQ(mixed.bodies.at(0).captured, kFirst + milliseconds(10));
  EXPECT_NEAR(joint_of(mixed).position.x(), 1.5, 1e-12);
  EXPECT_EQ(mixed.sequence, 0U) << "named after the frame before it";
}

TEST(FrameBetween, MixesVelocitiesAndStatesTheLargerVariance) {
  FrameResource a = frame_at(milliseconds(0), 1.0);
  FrameResource b = frame_at(milliseconds(40), 3.0);
  joint_of(a).velocity = {1.0, 0.0, 0.0};
  joint_of(b).velocity = {2.0, 0.0, 0.0};
  joint_of(a).velocity_variance = 0.1;
  joint_of(b).velocity_variance = 0.2;
  EXPECT_EQ(joint_of(quarter(a, b)).velocity, Eigen::Vector3d(1.25, 0.0, 0.0));
  EXPECT_EQ(joint_of(quarter(a, b)).velocity_variance, 0.2);
  joint_of(b).velocity.reset();
  EXPECT_FALSE(joint_of(quarter(a, b)).velocity);
}

TEST(FrameBetween, MixesHandsThatBothHaveAndThingsThatOnePersonHolds) {
  FrameResource a = frame_at(milliseconds(0), 1.0);
  FrameResource b = frame_at(milliseconds(40), 3.0);
  a.bodies[0].left_hand = HandPoints{{}, 0.01};
  b.bodies[0].left_hand = HandPoints{{}, 0.04};
  b.bodies[0].left_hand->points[20] = {0.4, 0.0, 0.0};
  a.bodies[0].right_hand = HandPoints{};
  a.props = {{"box", 3, {0, 0, 0}}, {"driver", 3, {0, 0, 0}}};
  b.props = {{"driver", 4, {1, 0, 0}}, {"box", 3, {1, 0, 0}}};
  const FrameResource mixed = quarter(a, b);
  ASSERT_TRUE(mixed.bodies[0].left_hand);
  EXPECT_NEAR(mixed.bodies[0].left_hand->points[20].x(), 0.1, 1e-12);
  EXPECT_EQ(mixed.bodies[0].left_hand->variance, 0.04);
  EXPECT_FALSE(mixed.bodies[0].right_hand) << "only one frame has it";
  ASSERT_EQ(mixed.props.size(), 1U) << "the other went from hand to hand";
  EXPECT_EQ(mixed.props[0].name, "box");
  EXPECT_EQ(mixed.props[0].holder, 3U);
  EXPECT_NEAR(mixed.props[0].position.x(), 0.25, 1e-12);
}

TEST(FrameBetween, AtTheFramesThemselvesItIsThese) {
  const FrameResource a = frame_at(milliseconds(0), 1.0);
  const FrameResource b = frame_at(milliseconds(40), 3.0);
  EXPECT_EQ(joint_of(between(a, b, a.captured)).position.x(), 1.0);
  EXPECT_NEAR(joint_of(between(a, b, b.captured)).position.x(), 3.0, 1e-12);
  EXPECT_EQ(joint_of(between(a, b, a.captured - milliseconds(5))).position.x(), 1.0)
      << "nothing is guessed beyond them";
  EXPECT_NEAR(joint_of(between(a, b, b.captured + milliseconds(5))).position.x(), 3.0, 1e-12);
}

TEST(FrameBetween, TwoFramesOfOneTimeAreTheFirst) {
  const FrameResource a = frame_at(milliseconds(0), 1.0);
  EXPECT_EQ(joint_of(between(a, frame_at(milliseconds(0), 3.0), a.captured)).position.x(), 1.0);
}

TEST(FrameBetween, HoldsOnlyBodiesOfBoth) {
  FrameResource a = frame_at(milliseconds(0), 1.0);
  FrameResource b = frame_at(milliseconds(40), 3.0);
  a.bodies.push_back(a.bodies[0]);
  a.bodies[1].id = 8;  // leaves
  b.bodies.insert(b.bodies.begin(), b.bodies[0]);
  b.bodies[0].id = 9;  // comes
  const FrameResource mixed = quarter(a, b);
  ASSERT_EQ(mixed.bodies.size(), 1U);
  EXPECT_EQ(mixed.bodies[0].id, 3U);
  EXPECT_NEAR(joint_of(mixed).position.x(), 1.5, 1e-12) << "by id, wherever it stands in the list";
}

TEST(FrameBetween, AJointOfOneFrameAloneIsNotTracked) {
  FrameResource a = frame_at(milliseconds(0), 1.0);
  joint_of(a, JointId::HandLeft) = joint_of(a);
  const FrameResource mixed = quarter(a, frame_at(milliseconds(40), 3.0));
  EXPECT_EQ(joint_of(mixed, JointId::HandLeft).state, JointState::NotTracked);
  EXPECT_EQ(joint_of(mixed).state, JointState::Tracked);
}

TEST(FrameBetween, StatesTheWorseOfBoth) {
  FrameResource a = frame_at(milliseconds(0), 1.0);
  FrameResource b = frame_at(milliseconds(40), 3.0);
  joint_of(b).state = JointState::Inferred;
  joint_of(a).variance = 0.0001;
  joint_of(b).variance = 0.0004;
  EXPECT_EQ(joint_of(quarter(a, b)).state, JointState::Inferred);
  EXPECT_EQ(joint_of(quarter(a, b)).variance, 0.0004);
  std::swap(joint_of(a).variance, joint_of(b).variance);
  EXPECT_EQ(joint_of(quarter(a, b)).variance, 0.0004);
  joint_of(b).variance.reset();
  EXPECT_EQ(joint_of(quarter(a, b)).variance, std::nullopt) << "not known of both";
}

TEST(FrameBetween, WhoeverContributedToOneContributes) {
  FrameResource a = frame_at(milliseconds(0), 1.0);
  FrameResource b = frame_at(milliseconds(40), 3.0);
  joint_of(a).contributors = 0b001;
  joint_of(a).shares = shared(1.0, 0.0);
  joint_of(b).contributors = 0b011;
  joint_of(b).shares = shared(0.2, 0.8);
  const JointResource mixed = joint_of(quarter(a, b));
  EXPECT_EQ(mixed.contributors, 0b011U);
  EXPECT_NEAR(mixed.shares.of(0), 0.75 * 1.0 + 0.25 * 0.2, 0.011);
  EXPECT_NEAR(mixed.shares.of(1), 0.25 * 0.8, 0.011);
  EXPECT_EQ(mixed.age, std::nullopt);
}

TEST(FrameBetween, SharesAreUnknownUnlessBothAreKnown) {
  FrameResource a = frame_at(milliseconds(0), 1.0);
  FrameResource b = frame_at(milliseconds(40), 3.0);
  joint_of(a).contributors = joint_of(b).contributors = 0b011;
  joint_of(a).shares = shared(0.5, 0.5);
  EXPECT_FALSE(joint_of(quarter(a, b)).shares.known());
  EXPECT_FALSE(joint_of(quarter(b, a)).shares.known());
  joint_of(b).contributors = 0;  // nobody's: then there is nothing to know
  EXPECT_NEAR(joint_of(quarter(a, b)).shares.of(0), 0.5, 0.011);
}

TEST(FrameBetween, WhatNobodySawGrowsOlderWithTime) {
  FrameResource a = frame_at(milliseconds(0), 1.0);
  FrameResource b = frame_at(milliseconds(40), 3.0);
  joint_of(a).age = 0.1;
  joint_of(b).age = 0.14;
  EXPECT_NEAR(joint_of(quarter(a, b)).age.value_or(-1.0), 0.11, 1e-9);
  joint_of(a).age.reset();
  EXPECT_NEAR(joint_of(quarter(a, b)).age.value_or(-1.0), 0.11, 1e-9) << "30 ms before the second";
  joint_of(b).age = 0.01;
  EXPECT_EQ(joint_of(quarter(a, b)).age, 0.0) << "it was seen in between";
  joint_of(b).age.reset();
  EXPECT_EQ(joint_of(quarter(a, b)).age, std::nullopt) << "a sensor's frame states none";
}

TEST(FrameBetween, WhatIsOfThePersonComesFromTheFrameBefore) {
  FrameResource a = frame_at(milliseconds(0), 1.0);
  FrameResource b = frame_at(milliseconds(40), 3.0);
  a.bodies[0].slot = 2;
  a.bodies[0].sides_confidence = 0.9;
  a.bodies[0].carried_for = 0.5;
  a.bodies[0].smoothed_over = b.bodies[0].smoothed_over = 2.5;
  b.bodies[0].slot = 5;
  const BodyResource body = quarter(a, b).bodies.at(0);
  EXPECT_EQ(body.slot, 2U);
  EXPECT_EQ(body.sides_confidence, 0.9);
  EXPECT_EQ(body.carried_for, 0.5);
  EXPECT_EQ(body.smoothed_over, 2.5);
}

TEST(FrameBetween, WithOtherSensorsTheBitsMeanSomethingElse) {
  const FrameResource a = frame_at(milliseconds(0), 1.0);
  FrameResource b = frame_at(milliseconds(40), 3.0);
  b.sensors = {"s2", "s1", "s3"};
  const FrameResource kept = quarter(a, b);
  EXPECT_EQ(kept.captured, a.captured);
  EXPECT_EQ(joint_of(kept).position.x(), 1.0);
}

TEST(FrameBetween, RaysStayDirectionsAndNeverMixWithPoints) {
  FrameResource a = frame_at(milliseconds(0), 1.0);
  FrameResource b = frame_at(milliseconds(40), 3.0);
  joint_of(a).measurement = joint_of(b).measurement = Measurement::Ray;
  joint_of(a).position = Eigen::Vector3d::UnitX();
  joint_of(b).position = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(joint_of(quarter(a, b)).position.norm(), 1.0, 1e-12);
  joint_of(b).measurement = Measurement::Point;
  EXPECT_EQ(joint_of(quarter(a, b)).state, JointState::NotTracked);
}

}  // namespace
}  // namespace chorus::resource
