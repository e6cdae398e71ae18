// Turns one layer of the sensor model up, down or off, for stress sweeps and ablations.
#pragma once

#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

/// The layers, as with_source() groups them.
enum class Source { Visibility, Yaw, Bias, Coloured, White, Gross, Delivery, Clock };

/// Returns the profile with one source of error multiplied by `factor`: 0 switches it off, 1 leaves
/// it as it is, and a larger factor means a larger error (a unit test checks this for each source,
/// up to 3).  What is multiplied:
///
/// - Visibility: the error of hidden joints, and how often visible joints are called inferred.
///   (Which joints are hidden is geometry, and does not change, except that at 0 none is; nor does
///   the share of hidden joints that is called inferred.)
/// - Yaw: the slopes beyond the reliable angle are raised to this power, so that the body shown
///   turns less and less but never backwards.  Above 1, left and right are swapped at a smaller
///   angle, closer to the reliable one; below 1 at a larger one, closer to half a turn; at 0 never.
/// - Bias, Coloured, White: the size of the error.
/// - Gross: the rates of teleports and ghosts, the probability that ids are swapped, and how far
///   legs are pulled together.
/// - Delivery: the shares of lost frames and of time at 15 Hz, the rate of gaps, and both jitters.
///   Latency is not an error and does not change.
/// - Clock: offset, drift, and the size and probability of a step.
///
/// Probabilities and shares are limited to 1, that of lost frames to 0.9, so that some still
/// arrive.
[[nodiscard]] Profile with_source(Profile profile, Source source, double factor);

}  // namespace chorus::synthetic::kinect
