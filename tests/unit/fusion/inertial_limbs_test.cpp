// Limbs that inertial sensors steer: hidden ones go on, seen ones are not harmed.
#include "fusion-server/fusion/inertial_limbs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/evaluation/limb_frame.h"
#include "tests/unit/fusion/body_room.h"

namespace chorus::fusion {
namespace {

using body_room::kSensors;
using body_room::kStart;
using body_room::standing;
using body_room::view_of;
using inertial::Limb;
using std::chrono::milliseconds;
using enum JointId;

const SensorId kSuit = *SensorId::parse("suit");

/// The left arm turned about the shoulder, in the plane of the body, and its forearm further.
Skeleton<WorldSpace> with_arm(double upper, double lower) {
  Skeleton<WorldSpace> body = standing();
  const Eigen::Vector3d shoulder = body[ShoulderLeft].position;
  body[ElbowLeft].position = shoulder + 0.27 * Eigen::Vector3d(std::cos(upper), std::sin(upper), 0);
  body[WristLeft].position =
      body[ElbowLeft].position +
      0.25 * Eigen::Vector3d(std::cos(lower), std::sin(lower), 0.1).normalized();
  return body;
}

/// What sensors on both parts of the left arm say, each wrong by `off` about the z axis.
std::vector<WornLimb> worn_on(const Skeleton<WorldSpace>& body, double off = 0.0) {
  std::vector<WornLimb> worn;
  for (const Limb limb : {Limb::UpperArmLeft, Limb::ForearmLeft}) {
    const auto tracked = evaluation::limb_from_joints(body, limb);
    const Eigen::Quaterniond wrong = exp_map(Eigen::Vector3d(0, 0, off));
    worn.push_back({kSuit, limb, wrong * tracked->world_from_limb,
                    deg(5) * deg(5) * Eigen::Matrix3d::Identity()});
  }
  return worn;
}

struct WornRoom {
  explicit WornRoom(Method method = Method::BodyFilter) {
    config.method = method;
    config.inertial.enabled = true;
  }

  /// Two sensors see the body; joints in `hidden` are shown by neither.
  FusedBody at(int step, const Skeleton<WorldSpace>& body, std::vector<WornLimb> worn,
               const std::vector<JointId>& hidden = {}) {
    Skeleton<WorldSpace> shown = body;
    for (const JointId id : hidden) shown[id] = {};
    Person person{PersonId{1}, {view_of(1, shown), view_of(2, shown)}};
    person.worn = std::move(worn);
    return memory.fuse({person}, {kStart + milliseconds(33) * step, kSensors}, config)[0];
  }

  FusionConfig config;
  Memory memory;
};

double off(const FusedBody& body, const Skeleton<WorldSpace>& exact, JointId id) {
  return (body.skeleton[id].position - exact[id].position).norm();
}

/// The arm swings while it is hidden for a second; returns how far the wrist is at its end.
struct Hidden {
  double wrist = 0.0;
  double leap = 0.0;   ///< Largest error of an instant's step after the arm is seen again [m],
  double first = 0.0;  ///< and that of the first instant.
  FusedBody last;
};

Hidden hide(WornRoom& room, double wrong, bool wears) {
  const auto arm = [](int step) {
    const double t = 0.033 * step;
    return with_arm(0.8 * std::sin(2.0 * t), 0.8 * std::sin(2.0 * t) + 0.9 * std::sin(1.3 * t));
  };
  const auto worn = [&](int step) {
    return wears ? worn_on(arm(step), wrong) : std::vector<WornLimb>{};
  };
  constexpr int kHide = 90, kShow = 120, kEnd = 150;
  Hidden result;
  std::optional<Eigen::Vector3d> error;
  for (int i = 0; i < kEnd; ++i) {
    const bool hidden = i >= kHide && i < kShow;
    const auto joints =
        hidden ? std::vector<JointId>{ElbowLeft, WristLeft} : std::vector<JointId>{};
    const FusedBody body = room.at(i, arm(i), worn(i), joints);
    const Eigen::Vector3d now = body.skeleton[WristLeft].position - arm(i)[WristLeft].position;
    if (i == kShow - 1) result.last = body, result.wrist = now.norm();
    if (i >= kShow && error) result.leap = std::max(result.leap, (now - *error).norm());
    if (i == kShow && error) result.first = (now - *error).norm();
    error = now;
  }
  return result;
}

TEST(InertialLimbs, WithoutThemNothingChanges) {
  WornRoom with;
  WornRoom without;
  without.config.inertial.enabled = false;
  for (int i = 0; i < 20; ++i) {
    const auto body = with_arm(0.05 * i, 0.3);
    const FusedBody a = with.at(i, body, {});
    const FusedBody b = without.at(i, body, {});
    for (std::size_t j = 0; j < kJointCount; ++j) {
      EXPECT_EQ(a.skeleton.joints[j].position, b.skeleton.joints[j].position);
      EXPECT_EQ(a.variance[j], b.variance[j]);
    }
    EXPECT_FALSE(a.sighted);
  }
}

TEST(InertialLimbs, AreNotAskedUnlessEnabled) {
  WornRoom room;
  room.config.inertial.enabled = false;
  const auto body = with_arm(0.3, 0.3);
  const FusedBody fused = room.at(0, body, worn_on(body, 1.0));
  EXPECT_TRUE(fused.worn_sources.empty());
  EXPECT_FALSE(fused.sighted);
}

TEST(InertialLimbs, AHiddenArmGoesOnByItsSensors) {
  for (const Method method : {Method::BodyFilter, Method::InverseVariance}) {
    WornRoom room(method);
    const Hidden with = hide(room, deg(4), true);
    EXPECT_LT(with.wrist, 0.05);
    EXPECT_EQ(with.last.skeleton[WristLeft].state, JointState::Inferred);
    EXPECT_EQ(with.last.contributors[index_of(WristLeft)], 0U);
    EXPECT_EQ(with.last.worn_contributors[index_of(WristLeft)], 1U);
    EXPECT_EQ(with.last.worn_sources, std::vector<SensorId>{kSuit});
    EXPECT_GT(with.last.variance[index_of(WristLeft)], 4e-4);
    EXPECT_NEAR(with.last.age[index_of(WristLeft)], 0.99, 0.04);
  }
  WornRoom room;
  EXPECT_GT(hide(room, 0.0, false).wrist, 0.15);
}

TEST(InertialLimbs, ASeenAgainArmIsHandedBackWithoutALeap) {
  for (const Method method : {Method::BodyFilter, Method::InverseVariance}) {
    WornRoom room(method);
    const Hidden back = hide(room, deg(15), true);
    EXPECT_LT(back.leap, 0.02) << static_cast<int>(method);
    // It begins where the sensors had led it, not beyond what views and sensors give together.
    EXPECT_LT(back.first, 0.003) << static_cast<int>(method);
  }
}

TEST(InertialLimbs, WhereViewsAndSensorDisagreeTheViewsStayAndTheStatedErrorGrows) {
  WornRoom agrees;
  WornRoom disagrees;
  const auto body = with_arm(0.3, 0.5);
  FusedBody fine;
  FusedBody wrong;
  for (int i = 0; i < 60; ++i) {
    fine = agrees.at(i, body, worn_on(body, 0.0));
    wrong = disagrees.at(i, body, worn_on(body, deg(90)));
  }
  EXPECT_LT(off(wrong, body, WristLeft), 0.01);
  const double stated = std::sqrt(wrong.variance[index_of(WristLeft)]);
  EXPECT_GT(stated, 2.0 * std::sqrt(fine.variance[index_of(WristLeft)]));
  EXPECT_EQ(wrong.variance[index_of(KneeLeft)], fine.variance[index_of(KneeLeft)]);
  EXPECT_EQ(wrong.worn_contributors[index_of(WristLeft)], 0U);
}

TEST(InertialLimbs, TheOrientationOfALimbComesWithItsCovariance) {
  WornRoom room;
  const auto body = with_arm(0.3, 0.9);
  const auto worn = worn_on(body);
  FusedBody fused;
  for (int i = 0; i < 30; ++i) fused = room.at(i, body, worn);
  const std::size_t wrist = index_of(WristLeft);
  EXPECT_LT(angular_distance(fused.skeleton.joints[wrist].orientation, worn[1].world_from_limb),
            deg(2));
  ASSERT_TRUE(fused.orientation_covariance[wrist].known());
  EXPECT_NEAR(fused.orientation_covariance[wrist].matrix().trace(), 3 * deg(5) * deg(5), 1e-6);
}

TEST(InertialLimbs, WhatDoesNotKnowItsDirectionHasNoSay) {
  WornRoom room;
  const auto body = with_arm(0.3, 0.5);
  auto worn = worn_on(body, deg(50));
  for (WornLimb& each : worn) each.covariance = Eigen::Matrix3d::Identity();  // 57 degrees
  FusedBody fused;
  for (int i = 0; i < 30; ++i) fused = room.at(i, body, worn);
  EXPECT_TRUE(fused.worn_sources.empty());
  for (WornLimb& each : worn) each.covariance.setConstant(std::nan(""));
  fused = room.at(30, body, worn);
  EXPECT_TRUE(fused.worn_sources.empty());
  EXPECT_TRUE(fused.skeleton[WristLeft].position.allFinite());
}

}  // namespace
}  // namespace chorus::fusion
