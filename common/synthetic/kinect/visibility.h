// Which joints a sensor really sees: rays against every body and occluder (sensor space, metres).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/body/skeleton.h"
#include "common/synthetic/body_shape.h"
#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

/// An oriented box: a car body, a pillar, a table.
struct Box {
  Eigen::Isometry3d sensor_from_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5);  ///< Half edge lengths [m]
};

/// Everything that can stand in a ray's way, in the space of one sensor.
struct Obstacles {
  std::vector<std::vector<Capsule>> bodies;  ///< Capsules of each person.
  std::vector<Box> boxes;
};

/// Does the segment from the origin to `end` meet the box before its end?
[[nodiscard]] bool blocks(const Box& box, const Eigen::Vector3d& end);

/// Share of the rays to each joint of body `self` that arrive, in [0, 1].  Capsules of the body
/// itself that contain the joint are passed through: the joint lies inside its own limb.  No rays:
/// all visible.
[[nodiscard]] std::array<double, kJointCount> visible_share(const Skeleton<SensorSpace>& body,
                                                            std::size_t self,
                                                            const Obstacles& obstacles,
                                                            const Visibility& visibility);

/// One frame further: what the SDK has noticed of each joint's being hidden follows what is hidden
/// now, so that a leg which passes is tracked on.
void notice(std::array<double, kJointCount>& hidden, const std::array<double, kJointCount>& visible,
            double dt, const Visibility& visibility);

}  // namespace chorus::synthetic::kinect
