// Judges by the posture alone where the front of a body is; swapping left and right does not change
// the result (docs/papers/sides.md, Posture).
//
// Knees bend forwards, elbows backwards; hands work in front of the shoulders; people bend
// forwards. Feet and heads are not used, because a body tracker places them too close to the sensor
// when it sees a person from behind.
#pragma once

#include <vector>

#include "fusion-server/flow/person.h"

namespace chorus::facing {

/// Log odds for "this is the front": proportional to the offset up to `at` metres, constant beyond.
struct Cue {
  double log_odds = 0.0;
  double at = 0.05;  ///< [m]

  bool operator==(const Cue&) const = default;
};

/// Learned by tests/learn/posture_weights.py from recordings of people who face a sensor.
struct PostureCues {
  Cue knees{1.39, 0.05};    ///< Knees in front of the line from hip to ankle.
  Cue wrists{1.64, 0.10};   ///< Wrists in front of the shoulders.
  Cue elbows{-1.49, 0.05};  ///< Elbows in front of the line from shoulder to wrist.
  Cue lean{0.56, 0.15};     ///< Shoulders in front of the hips.
  /// Arm joints that sensors in front of the person see and sensors behind infer; here `at` is a
  /// fraction of these joints.
  Cue hidden{0.5, 0.25};
  double same = 5.0;  ///< Time constant of the autocorrelation of postures [s].

  bool operator==(const PostureCues&) const = default;
};

/// Log odds that the front is where `forward` (unit, horizontal) points.  Uses all views together,
/// because they see the same posture.  Swapping the labels of a view changes nothing; reversing
/// `forward` reverses the sign.
[[nodiscard]] double posture_log_odds(const std::vector<SensorView>& views,
                                      const Eigen::Vector3d& forward, const PostureCues& cues);

}  // namespace chorus::facing
