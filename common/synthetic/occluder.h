// Things in the room that hide people: a car body, a pillar, a table.  They can move.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <Eigen/Geometry>

#include "common/base/duration.h"

namespace chorus::synthetic {

/// A box in world space that glides back and forth along `travel` once per `period`; it stands
/// still if either is zero.
struct Occluder {
  Eigen::Isometry3d world_from_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5);  ///< Half edge lengths [m]
  Eigen::Vector3d travel = Eigen::Vector3d::Zero();       ///< [m]
  Duration period{0};
};

/// A kind of thing: its name in the configuration, and its usual size.
struct OccluderKind {
  std::string_view name;
  double width = 0.0;   ///< Along the thing's x [m]
  double height = 0.0;  ///< [m]
  double length = 0.0;  ///< Along the thing's z [m]
};

/// All kinds are solid boxes: no sensor can see through below a table.
inline constexpr std::array kOccluderKinds{OccluderKind{"car", 0.8, 1.2, 1.8},
                                           OccluderKind{"pillar", 0.4, 2.5, 0.4},
                                           OccluderKind{"table", 1.2, 0.75, 0.8}};

/// A thing that stands with the centre of its underside at `foot`, turned about +y by `yaw` [rad].
[[nodiscard]] Occluder stand_thing(const OccluderKind& size, const Eigen::Vector3d& foot,
                                   double yaw);

/// world_from_box at this time after the scene's epoch.
[[nodiscard]] Eigen::Isometry3d place_of(const Occluder& occluder, Duration since_epoch);

/// Distance along the unit ray from `eye` to a box centred at the origin, all in the box's space;
/// none when the ray misses the box or the eye is inside it.
[[nodiscard]] std::optional<double> hit_box(const Eigen::Vector3d& half, const Eigen::Vector3d& eye,
                                            const Eigen::Vector3d& ray);

}  // namespace chorus::synthetic
