// Places that directions without depth gave: what somebody should check before they are used.
//
// A walk tells how well rays meet, not whether they meet where the person was.  Of 36 real cameras
// 6 came out more than 0.1 m off, with a stated radius and with residuals like those of the others
// (docs/benchmarks/camera.md).  So such a place is never Good, and it is used once somebody has
// accepted it.  A second measured distance that agrees to 50 mm is not enough: it held for 4 of the
// 6 places that were wrong.
#pragma once

#include "fusion-server/registration/registration.h"

namespace chorus::registration {

/// The registration with its places where the rays meet best, if all placed sensors sent
/// directions; otherwise unchanged.  The solver weighs distances, which draws cameras nearer to the
/// person the more their rays err: with 8 mrad by 2 % of the distance, 100 mm in a simulated rig.
/// Angles do not.  The master, the size, and the covariances stay.  `walk`: in step.
[[nodiscard]] Registration with_rays_met(Registration found, const std::vector<WalkTrack>& walk,
                                         const RegistrationConfig& config);

/// The registration with what is to be said of sensors whose tracks are `directions`: Provisional
/// at best, unconfirmed, with the distance to measure as a reason.  `found`: in metres
/// (with_scale()).
[[nodiscard]] Registration with_ray_doubts(Registration found, const std::vector<WalkTrack>& walk,
                                           const RegistrationConfig& config);

/// with_rays_met(), with_scale(), with_ray_doubts(): the last steps of every walk.
[[nodiscard]] Registration settled(Registration found, const std::vector<WalkTrack>& walk,
                                   const RegistrationConfig& config);

}  // namespace chorus::registration
