// Cameras that guess the depth of a person from the person's size.
//
// They know a joint's direction to centimetres and its distance to decimetres, and their frames say
// so: the stated covariances are long along the line of sight, by a share of the distance.  A walk
// that only such cameras saw is registered by directions, almost as by rays.
#pragma once

#include "fusion-server/registration/registration.h"

namespace chorus::registration {

/// True if most of the sensor's joints state an error along the line of sight of at least 4 % of
/// their distance and three times the error across it.
[[nodiscard]] bool guesses_depth(const WalkTrack& track);

/// The configuration for this walk.  It differs from `config` only if all sensors that saw somebody
/// guess depth; then what a depth sensor must fulfil gives way to what such cameras can.
[[nodiscard]] RegistrationConfig suited_to(const std::vector<WalkTrack>& walk,
                                           const RegistrationConfig& config);

}  // namespace chorus::registration
