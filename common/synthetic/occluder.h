// Things that stand or move in the room and hide people: a car body, a pillar, a table.
#pragma once

#include <Eigen/Geometry>

#include "common/base/duration.h"

namespace chorus::synthetic {

/// A box that glides to and fro along `travel` once per `period` (zero: it stands still).  World
/// space.
struct Occluder {
  Eigen::Isometry3d world_from_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5);  ///< Half edge lengths [m]
  Eigen::Vector3d travel = Eigen::Vector3d::Zero();       ///< [m]
  Duration period{0};
};

/// world_from_box at a time since the scene's epoch.
[[nodiscard]] Eigen::Isometry3d place_of(const Occluder& occluder, Duration since_epoch);

}  // namespace chorus::synthetic
