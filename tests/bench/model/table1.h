// Otto 7.2-7.3, Table 1: two sensors, a slow walk of 10 s, ICP on neck clouds, twenty times.
#pragma once

#include <cstdint>

#include "common/synthetic/kinect/profile.h"
#include "fusion-server/registration/registration.h"

namespace chorus::bench {

/// One experiment: two sensors `angle` apart at 2.5 m from the middle of the walk.
struct TableOneSetting {
  double angle = 0.0;      ///< [rad]
  int runs = 20;           ///< Walks; the sensors and their errors stay.
  std::uint64_t seed = 1;  ///< Of the set-up: sensors, person, walks.
  bool in_step = true;     ///< Otto 5.2.4: frames brought to common instants first.
};

/// Both tracks at the capture times of the first one, the other's joints interpolated between its
/// frames (Otto 5.2.4); instants that a gap lies over are left out.
void bring_in_step(registration::WalkTrack& target, registration::WalkTrack& source);

/// Mean distance of the found places from their centre, in the floor plane [m]; NaN when no run
/// found one.
[[nodiscard]] double repeatability(const synthetic::kinect::Profile& profile,
                                   const TableOneSetting& setting);

}  // namespace chorus::bench
