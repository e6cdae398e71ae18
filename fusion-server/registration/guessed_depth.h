// Cameras that guess the depth of a person from the person's size.
//
// They know a joint's place to centimetres across the line of sight and to decimetres along it.
// Their frames say so: the stated error along the line of sight is a fraction of the distance.  A
// walk that only such cameras saw is registered by directions, almost as by rays.  Cameras that
// send nothing but rays are given depths first (ray_depths.h).
#pragma once

#include "fusion-server/registration/registration.h"

namespace chorus::registration {

/// True if most of the sensor's joints have a guessed depth (common/body/guessed_depth.h).
[[nodiscard]] bool guesses_depth(const WalkTrack& track);

/// The configuration for this walk.  It differs from `config` only if all sensors that saw somebody
/// guess depth; then what a depth sensor must fulfil gives way to what such cameras can.
[[nodiscard]] RegistrationConfig suited_to(const std::vector<WalkTrack>& walk,
                                           const RegistrationConfig& config);

/// True if no place can come of this walk: no frame came, or all sensors that saw somebody are
/// cameras that send rays to which no depth could be given.  Each such camera, also one beside
/// other sensors, is `Refused` in `result` with its objection.
[[nodiscard]] bool nothing_to_solve(const std::vector<WalkTrack>& walk, Registration& result);

}  // namespace chorus::registration
