// What is counted of one sensor.
#pragma once

#include <array>
#include <vector>

#include "common/quality/sample.h"
#include "common/quality/sensor_quality.h"

namespace chorus::quality {

struct SensorTally {
  /// Views of each kind that are kept: 11 MB a sensor, every view of one person in two hours.
  static constexpr std::size_t kMostOffsets = 200'000;

  struct Offset {
    double at;  ///< [s]
    Eigen::Vector3d in_world;
    Eigen::Vector3d in_sensor;
  };
  struct ClockError {
    double at;
    Eigen::Vector3d off;       ///< Of the trunk [m].
    Eigen::Vector3d velocity;  ///< [m/s]
  };

  std::size_t frames = 0;
  std::size_t with_people = 0;
  std::size_t rays = 0;
  std::size_t repeated = 0;
  double first = 0.0;
  double last = 0.0;
  double longest_silence = 0.0;
  Sample lateness, residuals;
  std::array<Sample, kJointCount> joints;
  std::array<Sample, 4> by_distance;
  Thinned<Offset> offsets{kMostOffsets};
  Thinned<ClockError> clocks{kMostOffsets};
  std::size_t sided = 0;  ///< Views from the front that tell left from right.
  std::size_t exchanged = 0;
  std::vector<BodyFrame> before;  ///< Of its last frame with somebody.

  /// A frame of the sensor, captured at `at` [s].
  void add(const SensorFrame& frame, double at);
  /// `from` and `to`: the recording's first and last capture [s].
  [[nodiscard]] SensorQuality quality(double from, double to) const;
};

}  // namespace chorus::quality
