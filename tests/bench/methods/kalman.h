// A baseline that filters over time with a constant-velocity Kalman filter per joint.
//
// The filter of one point is the product's (fusion/point_filter.h); what is made of it differs.
#pragma once

#include <vector>

#include "fusion-server/registration/registration.h"
#include "tests/bench/methods/baseline.h"

namespace chorus::bench::baselines {

/// A body as a tracker states it, with the time it states for it.
struct Stated {
  Timestamp instant;
  PersonId id;
  Body body;
};

/// The way of OpenPTrack: each frame updates its person's joints as it arrives, by the time of
/// arrival, and the answer bears that time (but with the real elapsed time instead of a
/// fixed one, and noise to fit the sensors: 25 mm, 75 mm where inferred).  One answer per frame and
/// person, in order; left and right are put right from frame to frame.  `received` of the frames
/// must be set.
[[nodiscard]] std::vector<Stated> arrival_kalman(
    const std::vector<registration::WalkTrack>& sensors, const Registration& registration);

}  // namespace chorus::bench::baselines
