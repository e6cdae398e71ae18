// Turning one layer of the sensor model up, down or off: stress sweeps and ablations.
#pragma once

#include "common/synthetic/kinect/profile.h"

namespace chorus::synthetic::kinect {

/// The layers, as with_source() groups them.
enum class Source { Visibility, Yaw, Bias, Coloured, White, Gross, Delivery, Clock };

/// The profile with one source of error multiplied: 0 switches it off, 1 leaves it; more factor is
/// more error (a test holds each to it, up to 3).
///
/// Visibility: how far hidden joints are off, and how often visible ones are called inferred; which
/// joints are hidden is geometry and stays, as does the share of those that are called inferred.
/// Yaw: the slopes beyond the reliable angle are taken to this power, so that the body shown turns
/// less and less but never back; left and right are exchanged earlier, towards the reliable angle,
/// below 1 later, towards half a turn. Bias, Coloured, White: sizes.
/// Gross: rates of teleports and ghosts; probability of exchanged ids and share by which legs
/// merge. Delivery: share of drops and of 15 Hz, rate of gaps, both jitters; latency is no error
/// and stays. Clock: offset, drift, size and chance of a step.  Probabilities and shares stop at 1.
[[nodiscard]] Profile with_source(Profile profile, Source source, double factor);

}  // namespace chorus::synthetic::kinect
