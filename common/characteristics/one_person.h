// What one sensor recorded of one person: the raw material of all measurements in this room, or
// why a recording cannot be measured.
#pragma once

#include <optional>
#include <vector>

#include "common/base/result.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::characteristics {

/// The person in one frame.
struct Sight {
  Timestamp at;
  /// In sensor space turned upright about the sensor (+y is up), so that distances and lines of
  /// sight stay what they were.
  Skeleton<SensorSpace> body;
  bool standing = false;  ///< Their trunk moves more slowly than kStandingSpeed.
};

/// Somebody whose trunk is slower than this stands, or turns on the spot [m/s].
inline constexpr double kStandingSpeed = 0.25;
/// Less time of standing than this is not measured [s].
inline constexpr double kLeastStanding = 5.0;

/// Frames farther apart than this many usual steps have a gap between them.
inline constexpr double kUsualStep = 1.5;

struct OnePerson {
  SensorId sensor;
  std::vector<Sight> sights;      ///< In order of capture.
  std::vector<Timestamp> frames;  ///< Capture times of all frames, with or without the person.
  /// From the mean floor plane; identity where the sensor states none.
  Eigen::Quaterniond upright_from_sensor = Eigen::Quaterniond::Identity();
  bool has_floor = false;
  double step = 0.0;  ///< Median time between frames [s].
};

/// Middle of the joints of the spine that are seen (kCoreJoints without the head) [m]; none if
/// none is seen.
[[nodiscard]] std::optional<Eigen::Vector3d> trunk_of(const Skeleton<SensorSpace>& body);

/// Frames of one sensor in order of capture.  Refuses, saying what to record instead, if there is
/// nobody, more than one person, only rays, or less than kLeastStanding seconds of a person who
/// stands.  If a few frames have several bodies, the one nearest to the body before counts.
[[nodiscard]] Result<OnePerson> one_person(const std::vector<SensorFrame>& frames);

}  // namespace chorus::characteristics
