// Recordings with inertial sensors and optical truth of one take, made by others.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/evaluation/orientation_pair.h"
#include "common/evaluation/time_shift.h"
#include "common/inertial/limb.h"

namespace chorus::bench {

struct RealSensor {
  inertial::Limb limb = inertial::Limb::Pelvis;
  evaluation::OrientationTrack optical;                    ///< world_from_limb, +y up
  evaluation::OrientationTrack inertial;                   ///< inertial_from_sensor, +y up
  std::vector<evaluation::Timed<Eigen::Vector3d>> places;  ///< Of the limb's joint [m]
  evaluation::Signal acceleration;  ///< |specific force - gravity| of the sensor [m/s^2]
};

struct RealTake {
  std::string name;
  std::vector<RealSensor> sensors;
};

/// Both takes that are here: "xsens7" (Sy et al. 2020, a walk of 9.5 s, synchronised by a trigger)
/// and "xsens13" (TotalCapture S5 acting3, the first 25 s; $CHORUS_XSENS13 names the folder).
[[nodiscard]] Result<std::vector<RealTake>> real_takes();

/// Optical and inertial orientations of one sensor at the optical times.
[[nodiscard]] evaluation::OrientationPairs pairs_of(const RealSensor& sensor, double shift = 0.0);

}  // namespace chorus::bench
