// Where somebody stands and which way they face, from a fused frame as JSON.
#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "common/base/result.h"

namespace chorus::ctl {

struct Stance {
  double x = 0.0;    ///< Of the pelvis, in the world [m].
  double z = 0.0;    ///< [m]
  double yaw = 0.0;  ///< Of the way they face, about +y from +z [rad].
};

/// Of the one person in it.  NotFound: nobody, or hips and shoulders are not seen; Conflict: there
/// are more; Unavailable: left and right, and so the front, are uncertain.
[[nodiscard]] Result<Stance> stance_in(const nlohmann::json& frame);

/// The mean of somebody who stands still.  NotFound: of too few; Conflict: they move or turn.
[[nodiscard]] Result<Stance> steady(std::span<const Stance> seen);

}  // namespace chorus::ctl
