// Puts a suit's poses and cameras' pictures together as they come: pictures come late, because
// somebody has to find the person in them first.  Pure.
#pragma once

#include <deque>
#include <optional>

#include "common/positioning/tracker.h"
#include "common/sensor/sensor_frame.h"
#include "services/sensor/device/suit/suit_frames.h"

namespace chorus::positioner {

/// What is known of the person at the suit's newest pose.
struct LivePlace {
  Timestamp captured;
  suit::SuitPose pose;
  positioning::Tracked tracked;
};

/// Remembers the poses since the last picture.  When a picture comes, the tracker goes to the
/// picture's instant, and from there with the poses to now.
class LiveTracker {
 public:
  explicit LiveTracker(const positioning::TrackerSettings& settings);

  /// The place now; none before a camera has seen the person.
  std::optional<LivePlace> pose(const suit::SuitInstant& instant);
  /// A picture older than the one before, or older than all poses that are remembered, is left out
  /// (false).
  bool picture(Timestamp captured, positioning::Look look);
  /// The place at the last picture; none before a camera has seen the person.
  [[nodiscard]] const std::optional<LivePlace>& pictured() const { return pictured_place_; }
  /// Begins anew: the suit's file starts again, or its stream jumps in time.
  void forget();

 private:
  void advance(positioning::Tracker& tracker, const suit::SuitInstant& instant,
               std::vector<positioning::Look> looks);

  positioning::TrackerSettings settings_;
  positioning::Tracker at_picture_;  ///< As of the last picture.
  positioning::Tracker now_;
  std::deque<suit::SuitInstant> poses_;  ///< The last two seconds.
  std::optional<Timestamp> pictured_{};  ///< When the last picture was taken.
  std::optional<positioning::Tracked> tracked_{};
  std::optional<LivePlace> pictured_place_{};
};

}  // namespace chorus::positioner
