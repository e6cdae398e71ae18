// Where one sensor sees people: its field of view, in its own space.
//
// Before anything is known it is that of a usual body-tracking depth camera (70 by 60 degrees, 0.5
// to 4.5 m), less the edge, where only a part of a person is in the picture.  Then the sensor's own
// record counts: for how long it has seen people whom another saw there, too, and not seen people
// whom two others saw.  So a sensor with a wider or a longer view is soon expected to see more, and
// one before a shelf less.
#pragma once

#include <array>
#include <cstddef>
#include <map>

#include <Eigen/Core>

#include "common/base/strong_id.h"

namespace chorus::associate {

class SightField {
 public:
  /// Probability that the sensor sees somebody whose middle is at `place` [m, sensor space] and
  /// whom nobody hides from it; 0 behind the sensor, and where nobody is tracked.
  [[nodiscard]] double chance(const Eigen::Vector3d& place) const;

  /// For `time` [s], a person was there whom others saw; `seen` by this sensor, or not.
  void learn(const Eigen::Vector3d& place, bool seen, double time);

 private:
  static constexpr std::size_t kAngles = 24;     // of 7.5 degrees, across the half space ahead
  static constexpr std::size_t kDistances = 16;  // of 0.5 m
  struct Record {
    float seen = 0.0F, missed = 0.0F;  ///< [s]
  };
  [[nodiscard]] static std::size_t cell_of(const Eigen::Vector3d& place);

  std::array<Record, kAngles * kDistances> records_{};
};

using SightFields = std::map<SensorId, SightField>;

}  // namespace chorus::associate
