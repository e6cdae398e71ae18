// Which joints a sensor really sees, by casting rays against all bodies and occluders (sensor
// space, metres).
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

/// Everything that can block a ray, in the space of one sensor.
struct Obstacles {
  std::vector<std::vector<Capsule>> bodies;  ///< Capsules of each person.
  std::vector<Box> boxes;
};

/// True if the segment from the origin to `end` meets the box before its end.
[[nodiscard]] bool blocks(const Box& box, const Eigen::Vector3d& end);

/// The share of rays to each joint of body `self` that reach it, in [0, 1].  The body's own
/// capsules do not block rays to its core joints, nor to a joint that is inside them, as it is in
/// its own limb. If the profile has no rays, all joints are visible.
[[nodiscard]] std::array<double, kJointCount> visible_share(const Skeleton<SensorSpace>& body,
                                                            std::size_t self,
                                                            const Obstacles& obstacles,
                                                            const Visibility& visibility);

/// Advances by one frame.  The SDK notices only after a while that a joint is hidden, so it
/// continues to track a leg that is hidden for a moment.
void notice(std::array<double, kJointCount>& hidden, const std::array<double, kJointCount>& visible,
            double dt, const Visibility& visibility);

}  // namespace chorus::synthetic::kinect
