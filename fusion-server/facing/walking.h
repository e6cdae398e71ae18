// Estimates the direction in which a person walks from how the trunk moves in each view, so that a
// view that appears or disappears adds no speed.
#pragma once

#include <map>

#include "fusion-server/flow/person.h"

namespace chorus::facing {

struct WalkingCue {
  double log_odds = 3.0;   ///< Log odds that somebody who walks at full speed walks forwards.
  double from = 0.3;       ///< A lower speed counts as standing [m/s].
  double full = 1.0;       ///< Speed from which `log_odds` applies in full [m/s].
  double smoothing = 0.2;  ///< Time constant of the speed [s].
  double same = 0.5;       ///< Walking within this time is a single piece of evidence [s].
  /// Vertical speed of the trunk, as a share of its horizontal speed, up to which a movement can be
  /// walking; somebody who jumps, falls or turns over rises and sinks more.
  double level = 0.2;
  double steep = 0.4;  ///< Share from which it is no walking.

  bool operator==(const WalkingCue&) const = default;
};

class Walk {
 public:
  void follow(const std::vector<SensorView>& views, Timestamp instant, const WalkingCue& cue);
  /// Log odds that `forward` (unit, horizontal) points to the front of somebody upright.
  [[nodiscard]] double log_odds(const Eigen::Vector3d& forward, const WalkingCue& cue) const;

 private:
  struct Trunk {
    Timestamp seen;
    Eigen::Vector3d place;  ///< World [m].
  };

  std::map<SensorId, Trunk> trunks_;
  Timestamp followed_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< [m/s]
  double climb_ = 0.0;  ///< Mean of the size of the vertical speed [m/s].
};

}  // namespace chorus::facing
