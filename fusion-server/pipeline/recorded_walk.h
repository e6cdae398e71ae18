// The part of a recording that registration needs: the first minutes in which one person was seen
// alone.
#pragma once

#include <vector>

#include "fusion-server/registration/registration.h"

namespace chorus::pipeline {

/// Collects frames of all sensors, roughly in the order of capture, until there are enough.
class RecordedWalk {
 public:
  void take(SensorFrame frame);

  /// One person was seen alone for long enough, or the memory limit is reached.
  [[nodiscard]] bool enough() const { return alone_ >= wanted_ || used_up(); }
  /// A longer walk will not be taken.
  [[nodiscard]] bool used_up() const;
  /// Asks for as much again.
  void go_on();

  /// Of every sensor that delivered a frame, in id order.
  [[nodiscard]] const std::vector<registration::WalkTrack>& tracks() const { return tracks_; }

 private:
  registration::WalkTrack& track_of(const SensorId& sensor);

  std::vector<registration::WalkTrack> tracks_;
  Duration wanted_ = std::chrono::minutes(2);
  Duration alone_{0};
  Timestamp last_alone_ = Timestamp::min();
  std::size_t bodies_ = 0;   ///< Kept, of frames with one person.
  std::size_t several_ = 0;  ///< Kept, of frames with more.
};

}  // namespace chorus::pipeline
