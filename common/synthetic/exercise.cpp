#include "common/synthetic/exercise.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::synthetic {
namespace {

using enum JointId;

/// How everything beyond a joint turns about it.  Axes of the body: x to its left, y up, z ahead.
struct Turn {
  JointId joint;
  Eigen::Vector3d from, to;  ///< Smallest and largest angle about each axis [rad].
  Eigen::Vector3d hz;        ///< How often a second; none is a multiple of another.
};

constexpr double kQuarter = std::numbers::pi / 4;

// In the order in which they are applied: what is nearer to the trunk first.
const std::array<Turn, 10> kTurns{{
    {SpineBase, {0.0, -0.5, -0.4}, {0.7, 0.5, 0.4}, {0.19, 0.13, 0.23}},
    {Neck, {-0.4, 0.0, -0.3}, {0.5, 0.0, 0.3}, {0.31, 0.1, 0.21}},
    {ShoulderLeft, {-1.4, -0.4, 0.0}, {0.1, 0.4, 1.0}, {0.29, 0.17, 0.37}},
    {ElbowLeft, {-1.6, -0.3, 0.0}, {-0.5, 0.3, 0.3}, {0.41, 0.23, 0.13}},
    {ShoulderRight, {-1.4, -0.4, -1.0}, {0.1, 0.4, 0.0}, {0.27, 0.19, 0.33}},
    {ElbowRight, {-1.6, -0.3, -0.3}, {-0.5, 0.3, 0.0}, {0.43, 0.21, 0.17}},
    {HipLeft, {-1.0, -0.3, 0.0}, {0.1, 0.3, 0.5}, {0.35, 0.15, 0.25}},
    {KneeLeft, {0.4, 0.0, 0.0}, {1.2, 0.0, 0.0}, {0.37, 0.1, 0.1}},
    {HipRight, {-1.0, -0.3, -0.5}, {0.1, 0.3, 0.0}, {0.33, 0.18, 0.28}},
    {KneeRight, {0.4, 0.0, 0.0}, {1.2, 0.0, 0.0}, {0.39, 0.1, 0.1}},
}};

bool is_leg(JointId id) {
  const JointId parent = parent_of(id);
  return parent == HipLeft || parent == HipRight || parent == KneeLeft || parent == KneeRight ||
         parent == AnkleLeft || parent == AnkleRight;
}

bool is_beyond(JointId id, JointId joint) {
  while (id != SpineBase) {
    id = parent_of(id);
    if (id == joint) return true;
  }
  return false;
}

Eigen::Matrix3d body_axes(const Skeleton<WorldSpace>& pose) {
  Eigen::Vector3d left = pose[HipLeft].position - pose[HipRight].position;
  left.y() = 0.0;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (!(left.norm() > 1e-6)) return axes;
  axes.col(0) = left.normalized();
  axes.col(2) = axes.col(0).cross(Eigen::Vector3d::UnitY());
  return axes;
}

Eigen::Quaterniond turned(const Turn& turn, const Eigen::Matrix3d& axes, double t) {
  Eigen::Vector3d angles;
  for (int k = 0; k < 3; ++k) {
    const double share = 0.5 + 0.5 * std::sin(2 * std::numbers::pi * turn.hz[k] * t - kQuarter * k);
    angles[k] = turn.from[k] + share * (turn.to[k] - turn.from[k]);
  }
  return exp_map(axes * angles);
}

void rotate(Joint& joint, const Eigen::Quaterniond& by, const Eigen::Vector3d& about) {
  joint.position = about + by * (joint.position - about);
  joint.orientation = by * joint.orientation;
}

/// The trunk bends over the hips; the legs go along with their ends, but do not turn.
void bend(Skeleton<WorldSpace>& pose, const Eigen::Quaterniond& by) {
  const Eigen::Vector3d centre = pose[SpineBase].position;
  const std::array<JointId, 2> hips{HipLeft, HipRight};
  std::array<Eigen::Vector3d, 2> moved;
  for (std::size_t i = 0; i < hips.size(); ++i)
    moved[i] = centre + by * (pose[hips[i]].position - centre) - pose[hips[i]].position;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto id = static_cast<JointId>(j);
    if (is_leg(id))
      pose.joints[j].position += moved[is_beyond(id, HipLeft) ? 0 : 1];
    else
      rotate(pose.joints[j], by, centre);
  }
}

}  // namespace

Skeleton<WorldSpace> exercised(Skeleton<WorldSpace> pose, Duration since_epoch) {
  // The phase of a time since 1970 would lose precision.
  const double t = std::fmod(seconds(since_epoch), 1e4);
  const Eigen::Matrix3d axes = body_axes(pose);
  for (const Turn& turn : kTurns) {
    const Eigen::Quaterniond by = turned(turn, axes, t);
    if (turn.joint == SpineBase) {
      bend(pose, by);
      continue;
    }
    const Eigen::Vector3d about = pose[turn.joint].position;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (is_beyond(static_cast<JointId>(j), turn.joint)) rotate(pose.joints[j], by, about);
    }
  }
  return pose;
}

Person exercising(Person person) {
  return [person = std::move(person)](Duration since_epoch) {
    return exercised(person(since_epoch), since_epoch);
  };
}

}  // namespace chorus::synthetic
