// A baseline that filters over time with a constant-velocity Kalman filter per joint.
//
// The filter of a single point is the product's (fusion/point_filter.h); its use differs.
#pragma once

#include <vector>

#include "fusion-server/registration/registration.h"
#include "tests/bench/methods/baseline.h"

namespace chorus::bench::baselines {

/// A body as a tracker reports it, with the time that it states.
struct Stated {
  Timestamp instant;
  PersonId id;
  Body body;
};

/// The method of OpenPTrack: each frame updates its person's joints as it arrives, at the time of
/// arrival, and the result states that time (but with the real elapsed time instead of a fixed one,
/// and with noise that fits the sensors: 25 mm, 75 mm where inferred).  One result per frame and
/// person, in order; left and right are corrected from frame to frame.  `received` must be set in
/// all frames.
[[nodiscard]] std::vector<Stated> arrival_kalman(
    const std::vector<registration::WalkTrack>& sensors, const Registration& registration);

}  // namespace chorus::bench::baselines
