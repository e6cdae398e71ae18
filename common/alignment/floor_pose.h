// Where somebody stands on the floor and which way they face.
#pragma once

#include <span>

#include "common/base/result.h"

namespace chorus::alignment {

struct FloorPose {
  double x = 0.0;    ///< Place of the pelvis in world space [m].
  double z = 0.0;    ///< [m]
  double yaw = 0.0;  ///< Direction in which the person faces, about +y from +z [rad].
};

/// The mean pose of a person who stands still.  NotFound: too few poses; Conflict: the person
/// moved or turned.
[[nodiscard]] Result<FloorPose> steady(std::span<const FloorPose> seen);

}  // namespace chorus::alignment
