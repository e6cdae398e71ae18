// Matchers for our values; every failure names the number that was wrong.
//
//   EXPECT_THAT(fit, IsOk());
//   EXPECT_THAT(parse("x"), FailsWith(ErrorCode::Malformed));
//   EXPECT_THAT(b_from_a, IsometryNear(expected, mm(1), deg(0.1)));
//   EXPECT_THAT(fused, SkeletonNear(truth, mm(20)));
//
// NaN is never near anything.  Tested in matchers_test.cpp.
#pragma once

#include <string>

#include <gmock/gmock.h>

#include "common/base/result.h"
#include "common/body/bones.h"
#include "common/body/skeleton.h"
#include "common/geometry/rotation.h"

namespace chorus::testing {

MATCHER(IsOk, negation ? "is an error" : "is a value") {
  if (arg.has_value()) return true;
  *result_listener << "which is the error " << name_of(arg.error().code) << " \""
                   << to_string(arg.error()) << "\"";
  return false;
}

MATCHER_P(FailsWith, code, std::string("is the error ") + std::string(name_of(code))) {
  if (arg.has_value()) {
    *result_listener << "which is a value";
    return false;
  }
  *result_listener << "which is the error " << name_of(arg.error().code) << " \""
                   << to_string(arg.error()) << "\"";
  return arg.error().code == code;
}

MATCHER_P2(VectorNear, expected, metres, "is within " + ::testing::PrintToString(metres) + " m") {
  const double distance = (arg - expected).norm();
  *result_listener << "which is " << distance << " m away, at " << arg.transpose();
  return distance <= metres;
}

/// q and -q are the same rotation; anything that is not a unit quaternion is far from everything.
MATCHER_P2(RotationNear, expected, radians,
           "is within " + ::testing::PrintToString(radians) + " rad") {
  if (!is_unit(arg) || !is_unit(expected)) {
    *result_listener << "which is no rotation: " << arg.coeffs().transpose();
    return false;
  }
  const double angle = angular_distance(arg, expected);
  *result_listener << "which is " << angle << " rad away";
  return angle <= radians;
}

MATCHER_P3(IsometryNear, expected, metres, radians,
           "is within " + ::testing::PrintToString(metres) + " m and " +
               ::testing::PrintToString(radians) + " rad") {
  const Eigen::Isometry3d difference = expected.inverse() * arg;
  const double distance = (arg.translation() - expected.translation()).norm();
  const double angle = Eigen::AngleAxisd(difference.linear()).angle();
  *result_listener << "which is " << distance << " m and " << angle << " rad away";
  return arg.matrix().allFinite() && distance <= metres && angle <= radians;
}

/// Requires the same states, and at most `metres` between any joints that are seen.
MATCHER_P2(SkeletonNear, expected, metres, "is within " + ::testing::PrintToString(metres) + " m") {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Joint& joint = arg.joints[i];
    const Joint& wanted = expected.joints[i];
    if (joint.state != wanted.state) {
      *result_listener << "whose " << kJointNames[i] << " has another state";
      return false;
    }
    if (wanted.state == JointState::NotTracked) continue;
    const double distance = (joint.position - wanted.position).norm();
    if (!(distance <= metres)) {
      *result_listener << "whose " << kJointNames[i] << " is " << distance << " m away";
      return false;
    }
  }
  return true;
}

/// Largest distance between joints seen in both [m]; for messages.  Zero when there is none.
template <class Space>
double largest_distance(const Skeleton<Space>& a, const Skeleton<Space>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!a.joints[i].seen() || !b.joints[i].seen()) continue;
    largest = std::max(largest, (a.joints[i].position - b.joints[i].position).norm());
  }
  return largest;
}

}  // namespace chorus::testing
