// Keeps the world the same from one registration to the next.
//
// A solve puts the origin of the world below its master, with +z in the master's viewing direction.
// All users of the output (a VRED scene, marks on the floor) rely on the previous world, so a new
// registration is moved into that one: only about +y and along the floor, because each solve
// estimates the floor again.
#pragma once

#include <optional>

#include "common/base/result.h"
#include "fusion-server/flow/registration.h"

namespace chorus::core {

/// Distance [m] from a sensor to the walk, at which rotation errors are judged.
inline constexpr double kReach = 2.5;

/// The origin of a new world, given in the present one.
struct Origin {
  double x = 0.0;    ///< [m]
  double z = 0.0;    ///< [m]
  double yaw = 0.0;  ///< Yaw of the new +z, about +y from the present +z [rad].

  bool operator==(const Origin&) const = default;
};

/// The place in another world; its covariance is rotated accordingly.
[[nodiscard]] Extrinsics moved(Extrinsics place, const Eigen::Isometry3d& new_from_old);

/// Where people rely on each sensor to stand: its anchor, or else its place.
[[nodiscard]] Anchors anchors_of(const Registration& registration);

/// The registration, moved into the world of these anchors.  This is decided by the largest group
/// of sensors whose relative places are the same in both (within 0.3 m); of equally large groups,
/// by the one with the master.  Within the group, those that do not fit the rest are left out (60
/// mm or more), so that a sensor which was pushed does not pull the world.  The anchors stay as
/// they are, so that errors of many registrations do not add up; a sensor that does not fit is
/// anchored at its new place. Unchanged if they have no sensor in common.
[[nodiscard]] Registration in_world_of(const Anchors& anchors, Registration candidate);

/// How the world moved from one registration to the next if all that happened is that its origin
/// was moved: every sensor that both have stands where it stood.  None: nothing moved, or something
/// else.
[[nodiscard]] std::optional<Eigen::Isometry3d> moved_world(const Registration& before,
                                                           const Registration& after);

inline constexpr double kMaxOrigin = 1000.0;  ///< Along x and along z [m].
/// The registration in the world whose origin is `origin`, where all sensors are anchored where
/// they stand.  Errors: NotFound (no sensor has a place), InvalidArgument (not finite, or beyond
/// kMaxOrigin).
[[nodiscard]] Result<Registration> with_origin(Registration registration, const Origin& origin);

}  // namespace chorus::core
