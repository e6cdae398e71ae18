// Repeats Otto 7.2-7.3, Table 1: two sensors, a slow walk of 10 s, ICP on neck clouds, twenty
// times.
#pragma once

#include <cstdint>

#include "common/synthetic/kinect/profile.h"
#include "fusion-server/registration/registration.h"

namespace chorus::bench {

/// One experiment: two sensors, `angle` apart and 2.5 m from the middle of the walk.
struct TableOneSetting {
  double angle = 0.0;      ///< [rad]
  int runs = 20;           ///< Number of walks; the sensors and their errors stay the same.
  std::uint64_t seed = 1;  ///< Seed of the set-up: sensors, person, walks.
  bool in_step = true;     ///< Otto 5.2.4: frames are first moved to common instants.
};

/// Resamples both tracks at the capture times of the first one, by interpolating the other's joints
/// (Otto 5.2.4); instants within a gap are left out.
void bring_in_step(registration::WalkTrack& target, registration::WalkTrack& source);

/// Mean distance of the estimated places from their centre, in the floor plane [m]; NaN when no run
/// gave one.
[[nodiscard]] double repeatability(const synthetic::kinect::Profile& profile,
                                   const TableOneSetting& setting);

}  // namespace chorus::bench
