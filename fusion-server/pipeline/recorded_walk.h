// The part of a recording that registration needs: the first minutes in which one person is seen
// alone.
#pragma once

#include <vector>

#include "fusion-server/registration/registration.h"

namespace chorus::pipeline {

/// Collects frames of all sensors, roughly ordered by capture, until there are enough.
class RecordedWalk {
 public:
  void take(SensorFrame frame);

  /// One person was seen alone for long enough, or the memory limit is reached.
  [[nodiscard]] bool enough() const { return alone_ >= wanted_ || used_up(); }
  /// The limit of memory is reached: the walk can get no longer.
  [[nodiscard]] bool used_up() const;
  /// Continues collecting until the walk is longer by the same length again.
  void go_on();

  /// One track for each sensor that delivered a frame, ordered by id.
  [[nodiscard]] const std::vector<registration::WalkTrack>& tracks() const { return tracks_; }

 private:
  registration::WalkTrack& track_of(const SensorId& sensor);

  std::vector<registration::WalkTrack> tracks_;
  Duration wanted_ = std::chrono::minutes(2);
  Duration alone_{0};
  Timestamp last_alone_ = Timestamp::min();
  std::size_t bodies_ = 0;   ///< Number kept from frames with one person.
  std::size_t several_ = 0;  ///< Number kept from frames with more people.
};

}  // namespace chorus::pipeline
