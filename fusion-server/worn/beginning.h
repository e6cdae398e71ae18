// How the wearing of inertial sensors began, as a later look at the same recording knows it.
//
// Live, a calibration serves from the instant at which it is found.  A recording can be read twice:
// a first pass finds how each sensor sits, a second one begins with it, so that the first seconds
// have its help, too.  The second pass goes on as a live server does: headings are followed, and a
// sensor that does not agree is told as slipped and calibrated again.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/strong_id.h"
#include "common/evaluation/calibrate.h"
#include "common/time/timestamp.h"

namespace chorus::worn {

/// The best calibration of one sensor before it first slipped.
struct FirstCalibration {
  /// Its heading is that of `known`.
  evaluation::CalibrationFit fit;
  double direction_sigma = 0.0;  ///< WornSensor::direction_sigma() [rad]
  double known = 0.0;            ///< When the sensor was first calibrated [s].
};

/// Where somebody was first seen.
struct FirstSight {
  Timestamp instant;
  Eigen::Vector3d place;  ///< Of the body's middle [m].
};

/// One source on its first wearer.
struct Beginning {
  SensorId source;
  PersonId wearer;
  FirstSight seen;
  std::map<std::string, FirstCalibration> sensors;  ///< By name.
};

}  // namespace chorus::worn
