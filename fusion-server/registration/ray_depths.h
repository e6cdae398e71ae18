// Gives rays a depth, so that a walk registers cameras that send directions alone.
//
// Where no sensor measures points, the rig of cameras is solved from the rays (ray_rig.h), and made
// as large as a person of 1.70 m asks for: its depths are then guessed from the size of the person,
// as those of cameras that guess depth themselves, and the rest is the same (guessed_depth.h,
// common_scale.h: one distance or the stature makes metres of it).  Beside sensors that measure
// points, each camera is placed among the points of the sensor with which it saw most.
#pragma once

#include <vector>

#include "fusion-server/registration/registration.h"

namespace chorus::registration {

/// The walk with points in place of rays, each along its ray, with a covariance that says how
/// little is known along it.  A camera that cannot be placed keeps its rays, and `objection` says
/// why.  Tracks of points are unchanged.
[[nodiscard]] std::vector<WalkTrack> with_ray_depths(std::vector<WalkTrack> walk,
                                                     const RegistrationConfig& config);

}  // namespace chorus::registration
