// Keeps the world the same from one registration to the next.
//
// A solve puts the origin of the world below its master, with +z in the master's viewing direction.
// All users of the output (a VRED scene, marks on the floor) rely on the previous world, so a new
// registration is moved into that one: only about +y and along the floor, because each solve
// estimates the floor again.
#pragma once

#include <map>

#include "common/base/result.h"
#include "fusion-server/flow/registration.h"

namespace chorus::core {

/// Distance [m] from a sensor to the walk, at which rotation errors are judged.
inline constexpr double kReach = 2.5;

using Places = std::map<SensorId, Extrinsics>;

/// The origin of a new world, given in the present one.
struct Origin {
  double x = 0.0;    ///< [m]
  double z = 0.0;    ///< [m]
  double yaw = 0.0;  ///< Yaw of the new +z, about +y from the present +z [rad].

  bool operator==(const Origin&) const = default;
};

/// The place in another world; its covariance is rotated accordingly.
[[nodiscard]] Extrinsics moved(Extrinsics place, const Eigen::Isometry3d& new_from_old);

/// The registration, moved into the world in which sensors stand as in `before`.  This is decided
/// by the largest group of sensors whose relative places are the same in both (within 0.3 m); of
/// equally large groups, by the one with the master.  So a sensor that was moved does not change
/// the world while two others agree.  Unchanged if they have no sensor in common.
[[nodiscard]] Registration in_world_of(const Places& before, Registration candidate);

inline constexpr double kMaxOrigin = 1000.0;  ///< Along x and along z [m].
/// The registration in the world whose origin is `origin`.  Errors: NotFound (no sensor has a
/// place), InvalidArgument (not finite, or beyond kMaxOrigin).
[[nodiscard]] Result<Registration> with_origin(Registration registration, const Origin& origin);

}  // namespace chorus::core
