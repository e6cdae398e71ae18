// A hand's skeleton as Biovision BVH (4.2): the template that suits and gloves load, or a take of a
// moving hand.
//
// Joints are called LeftHand, LeftHandThumb1, ... as Mixamo and MotionBuilder do; lengths are
// centimetres; the channels of each joint "Zrotation Xrotation Yrotation" in degrees, the root's
// with its position before them.
#pragma once

#include <span>
#include <string>

#include <Eigen/Geometry>

#include "common/hand/skeleton.h"

namespace chorus::hand {

/// A skeleton in a pose: the wrist's place and turn, and how each joint is turned against its
/// parent.  The rotations of the tips mean nothing.
struct Pose {
  Eigen::Vector3d wrist = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  std::array<Eigen::Quaterniond, kHandJoints> local = rest();

  [[nodiscard]] static std::array<Eigen::Quaterniond, kHandJoints> rest();
};

/// Where the joints of a posed hand are [m].
[[nodiscard]] std::array<Eigen::Vector3d, kHandJoints> joints_of(const Skeleton& skeleton,
                                                                 const Pose& pose);

/// Without poses: one frame of the rest pose.
[[nodiscard]] std::string bvh_of(const Skeleton& skeleton, std::span<const Pose> poses = {},
                                 double rate_hz = 60.0);

}  // namespace chorus::hand
