#include "common/synthetic/kinect/fitted_body.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/builders.h"

namespace chorus::synthetic::kinect {
namespace {

using enum JointId;

Skeleton<SensorSpace> person() {
  return to_sensor(testing::sensor_pose({0, 1, 0}, 0.0).inverse(),
                   testing::standing_person({0, 0, 2.3}, deg(180)));
}

Proportions exact_ones() {
  Proportions all;
  all.fill(1.0);
  return all;
}

double length(const Skeleton<SensorSpace>& body, const Bone& bone) {
  return (body[bone.child].position - body[bone.parent].position).norm();
}

TEST(FittedBody, OfAnExactBodyIsThatBody) {
  const auto exact = person();
  const auto body = fitted(exact, exact, 1.0, exact_ones());
  for (std::size_t i = 0; i < kJointCount; ++i) {
    EXPECT_LT((body.joints[i].position - exact.joints[i].position).norm(), 1e-9);
  }
}

TEST(FittedBody, HasTheTrueBonesTimesScaleAndProportionHoweverJointsErr) {
  const auto exact = person();
  auto erring = exact;
  Draw draw{1};
  for (Joint& joint : erring.joints) joint.position += 0.03 * draw.gauss3();
  Proportions proportions = exact_ones();
  proportions[3] = 1.1;
  const auto body = fitted(erring, exact, 0.9, proportions);
  for (std::size_t i = 0; i < kBones.size(); ++i) {
    const double expected = 0.9 * proportions[i] * length(exact, kBones[i]);
    EXPECT_NEAR(length(body, kBones[i]), expected, 1e-9);
  }
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  for (const JointId id : kCoreJoints) moved += body[id].position - erring[id].position;
  EXPECT_LT(moved.norm(), 1e-9) << "the middle of the trunk stays";
}

TEST(FittedBody, LeavesAJointAloneWhoseParentIsNotSeen) {
  const auto exact = person();
  auto erring = exact;
  erring[ElbowLeft] = Joint{};
  const auto body = fitted(erring, exact, 1.2, exact_ones());
  EXPECT_FALSE(body[ElbowLeft].seen());
  // The wrist differs only by the distance by which the trunk is moved back.
  const Eigen::Vector3d back = body[SpineBase].position - exact[SpineBase].position;
  EXPECT_LT((body[WristLeft].position - exact[WristLeft].position - back).norm(), 1e-9);
}

TEST(Proportions, AreTheSameLeftAndRightAndDifferByPerson) {
  BodyFit fit;
  fit.proportion = 0.04;
  const Proportions one = proportions_of(fit, {1, 0, 0});
  const Proportions again = proportions_of(fit, {1, 5, 0});
  const Proportions other = proportions_of(fit, {1, 0, 1});
  EXPECT_EQ(one, again) << "one SDK fits one body, whichever sensor looks";
  EXPECT_NE(one, other);
  const auto of = [&](JointId child) {
    for (std::size_t i = 0; i < kBones.size(); ++i) {
      if (kBones[i].child == child) return one[i];
    }
    return 0.0;
  };
  EXPECT_EQ(of(KneeLeft), of(KneeRight));
  EXPECT_NE(of(KneeLeft), of(AnkleLeft));
}

TEST(Scale, HasTheSizeAndTheMemoryOfTheLog) {
  const Profile profile = nominal_profile("D");
  Stand stand;
  stand.speed.fill(1.0);
  FitState state;
  std::vector<double> scales;
  for (int i = 0; i < 60'000; ++i) {
    const double time = 1e6 + i * 0.0333;
    advance(state, stand, {time, 0.0333}, profile, {1, 0, 0});
    scales.push_back(scale_of(state, time, profile.fit, {1, 0, 0}) - 1.0);
  }
  double squares = 0;
  double next = 0;
  double third = 0;
  for (std::size_t i = 0; i + 10 < scales.size(); ++i) {
    squares += scales[i] * scales[i];
    next += scales[i] * scales[i + 1];
    third += scales[i] * scales[i + 10];
  }
  EXPECT_NEAR(std::sqrt(squares / 60'000), 0.059, 0.006);
  EXPECT_NEAR(next / squares, 0.98, 0.015);
  EXPECT_NEAR(third / squares, 0.65, 0.06);
}

TEST(Scale, StandsStillWithThePerson) {
  const Profile profile = nominal_profile("D");
  Stand stand;
  FitState state;
  advance(state, stand, {1e6, 0.0333}, profile, {1, 0, 0});
  const double before = state.scale.value().x();
  for (int i = 1; i < 30; ++i)
    advance(state, stand, {1e6 + i * 0.0333, 0.0333}, profile, {1, 0, 0});
  EXPECT_NEAR(state.scale.value().x(), before, 0.1);
}

}  // namespace
}  // namespace chorus::synthetic::kinect
