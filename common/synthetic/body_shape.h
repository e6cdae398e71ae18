// A body as capsules around its bones, for depth and colour images.
#pragma once

#include <optional>
#include <vector>

#include "common/body/skeleton.h"

namespace chorus::synthetic {

struct Capsule {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< [m]
  double radius = 0.0;                             ///< [m]
};

/// One capsule for each bone whose two joints are seen, and a ball for the head if that is seen.
[[nodiscard]] std::vector<Capsule> capsules_of(const Skeleton<SensorSpace>& body);

/// Distance from the origin along the unit ray to the capsule's surface; none when the ray misses
/// the capsule or the surface is behind the origin.  The origin must be outside.
[[nodiscard]] std::optional<double> hit(const Capsule& capsule, const Eigen::Vector3d& ray);

}  // namespace chorus::synthetic
