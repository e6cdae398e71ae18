// Which world the places of a registration are in, and how that world stays.
//
// A solve puts its world below its master and turns it the way the master looks.  Everybody who
// works with the output (a VRED scene, marks on the floor) has the world that was there before, so
// a new registration is moved into that one: about +y and along the floor only, since each solve
// knows its own floor.
#pragma once

#include <map>

#include "common/base/result.h"
#include "fusion-server/flow.h"

namespace chorus::core {

using Places = std::map<SensorId, Extrinsics>;

/// Where the world is to begin, in the world as it is now.
struct Origin {
  double x = 0.0;    ///< [m]
  double z = 0.0;    ///< [m]
  double yaw = 0.0;  ///< Of the new +z, about +y from the +z there is now [rad].

  bool operator==(const Origin&) const = default;
};

/// The place in another world; its covariance is turned along.
[[nodiscard]] Extrinsics moved(Extrinsics place, const Eigen::Isometry3d& new_from_old);

/// The registration with its world moved to where the sensors stand as in `before`.  Most of those
/// that both place decide (0.3 m), so that one that was moved carries the world with it only where
/// there is no other.  As it is when they have no sensor in common.
[[nodiscard]] Registration in_world_of(const Places& before, Registration candidate);

/// The registration in the world that begins at `origin`.  Errors: NotFound (no sensor has a
/// place), InvalidArgument (not finite, or beyond kMaxOrigin).
inline constexpr double kMaxOrigin = 1000.0;  ///< Along x and along z [m].
[[nodiscard]] Result<Registration> with_origin(Registration registration, const Origin& origin);

}  // namespace chorus::core
