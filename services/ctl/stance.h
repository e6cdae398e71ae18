// Where a person stands and which way the person faces, from a fused frame as JSON.
#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "common/base/result.h"

namespace chorus::ctl {

struct Stance {
  double x = 0.0;    ///< Place of the pelvis in world space [m].
  double z = 0.0;    ///< [m]
  double yaw = 0.0;  ///< Direction in which the person faces, about +y from +z [rad].
};

/// The stance of the only person in the frame.  NotFound: nobody, or hips and shoulders are not
/// seen; Conflict: several people; Unavailable: left and right are uncertain, and therefore the
/// front.
[[nodiscard]] Result<Stance> stance_in(const nlohmann::json& frame);

/// The mean stance of a person who stands still.  NotFound: too few stances; Conflict: the person
/// moved or turned.
[[nodiscard]] Result<Stance> steady(std::span<const Stance> seen);

}  // namespace chorus::ctl
