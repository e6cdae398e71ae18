// The part of a recording that registration needs: the first minutes in which one person is seen
// alone.
#pragma once

#include <vector>

#include "common/sensor/sensor_frame.h"
#include "fusion-server/registration/registration.h"

namespace chorus::pipeline {

/// Collects frames of all sensors, which come roughly in order of capture, until there are enough.
class RecordedWalk {
 public:
  void take(SensorFrame frame);

  /// True if one person was seen alone for long enough, or the memory limit is reached.
  [[nodiscard]] bool enough() const { return alone_ >= wanted_ || used_up(); }
  /// True if the memory limit is reached: the walk cannot become longer.
  [[nodiscard]] bool used_up() const;
  /// Makes enough() false until a person was seen alone for two more minutes.
  void go_on();

  /// One track for each sensor that has delivered a frame, ordered by id.
  [[nodiscard]] const std::vector<registration::WalkTrack>& tracks() const { return tracks_; }

 private:
  registration::WalkTrack& track_of(const SensorId& sensor);

  std::vector<registration::WalkTrack> tracks_;
  Duration wanted_ = std::chrono::minutes(2);
  Duration alone_{0};
  Timestamp last_alone_ = Timestamp::min();
  std::size_t bodies_ = 0;   ///< Bodies kept from frames with one person.
  std::size_t several_ = 0;  ///< Bodies kept from frames with more people.
};

}  // namespace chorus::pipeline
