// The one factor that cameras which guess depth leave open, and what fixes it.
//
// Rays do not change when everything is larger and farther away.  So where only such cameras stand,
// all distances are wrong by one factor s, that of the guessed size of the person.  A measured
// distance m between two of them gives s = m / |t_a - t_b|; the stature of the person, less well,
// by the lengths of leg and trunk.  Then every position t becomes s t, about the origin of the
// world, and every point x of such a sensor s x, about the sensor's origin.  The variance of s is
// added to each covariance: sigma^2 t t^T, rank one; with measured distances the covariances of all
// places with each other are conditioned on these instead, which leaves no common factor in them.
// docs/decisions/0082-scale-of-cameras-that-guess-depth.md.
#pragma once

#include "fusion-server/registration/registration.h"

namespace chorus::registration {

/// The registration in metres, if all placed sensors guess depth; otherwise unchanged.  Without a
/// usable length the factor stays 1 and a reason says that the scale is unknown; a sensor is then
/// provisional, but never refused for it.  A reason names a distance that differs from what the
/// guessed size of the person says by more than 2.5 sigma.  `walk`: what `found` was solved from.
[[nodiscard]] Registration with_scale(Registration found, const std::vector<WalkTrack>& walk,
                                      const RegistrationConfig& config);

}  // namespace chorus::registration
