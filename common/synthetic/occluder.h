// Things that stand or move in the room and hide people: a car body, a pillar, a table.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <Eigen/Geometry>

#include "common/base/duration.h"

namespace chorus::synthetic {

/// A box that glides back and forth along `travel` once per `period` (zero travel: it stands
/// still). World space.
struct Occluder {
  Eigen::Isometry3d world_from_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5);  ///< Half edge lengths [m]
  Eigen::Vector3d travel = Eigen::Vector3d::Zero();       ///< [m]
  Duration period{0};
};

/// The name of a thing in the configuration, and its usual size.
struct OccluderKind {
  std::string_view name;
  double width = 0.0;   ///< Along its own x [m]
  double height = 0.0;  ///< [m]
  double length = 0.0;  ///< Along its own z [m]
};

/// All are solid boxes: nobody can look through under a table.
inline constexpr std::array kOccluderKinds{OccluderKind{"car", 0.8, 1.2, 1.8},
                                           OccluderKind{"pillar", 0.4, 2.5, 0.4},
                                           OccluderKind{"table", 1.2, 0.75, 0.8}};

/// Places a thing: the middle of its underside, and its yaw about +y [rad].
[[nodiscard]] Occluder stand_thing(const OccluderKind& size, const Eigen::Vector3d& foot,
                                   double yaw);

/// world_from_box at a time since the scene's epoch.
[[nodiscard]] Eigen::Isometry3d place_of(const Occluder& occluder, Duration since_epoch);

/// Distance along the unit ray from `eye` to a box around the origin, all in the box's own space;
/// none when the ray misses or the eye is inside.
[[nodiscard]] std::optional<double> hit_box(const Eigen::Vector3d& half, const Eigen::Vector3d& eye,
                                            const Eigen::Vector3d& ray);

}  // namespace chorus::synthetic
