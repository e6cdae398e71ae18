// A hand as tapered capsules in the camera's axes: fingers from the scan's lengths and widths, the
// palm as the hull of balls.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "common/hand/bvh.h"
#include "common/hand/skeleton.h"

namespace chorus::hand {

struct Ball {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0.0;                               ///< [m]
};

struct Capsules {
  std::vector<std::array<Ball, 2>> fingers;
  std::vector<Ball> palm;  ///< Their hull is the palm.
};

[[nodiscard]] Capsules capsules_of(const Skeleton& skeleton, const Pose& pose);

}  // namespace chorus::hand
