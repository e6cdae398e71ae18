// Judges by the posture alone where the front of a body is; swapping left and right does not change
// the result (docs/papers/sides.md, Posture).
//
// Knees bend forwards: they are hinges whose axis shows where left is, however somebody stands,
// lies or turns over.  Elbows bend backwards, hands work in front of the shoulders and people bend
// forwards, while they are upright; the elbows of others are hinges, too.  Toes are ahead of
// ankles; but a tracker that sees a person from behind may turn the feet towards itself, with the
// labels, so feet count only in views in which they point away from the sensor. Heads are not used:
// they are drawn towards the sensor, too.
#pragma once

#include <vector>

#include "fusion-server/facing/trunk.h"

namespace chorus::facing {

/// Log odds for "this is the left": proportional to the offset up to `at` metres, constant beyond.
struct Cue {
  double log_odds = 0.0;
  double at = 0.05;  ///< [m]

  bool operator==(const Cue&) const = default;
};

/// Learned by tests/learn/posture_weights.py from recordings of people who face a sensor.
struct PostureCues {
  /// How far knees are off the line from hip to ankle, times the cosine between the axis about
  /// which the leg is bent and the left of the person.
  Cue knees{1.38, 0.05};
  Cue wrists{1.66, 0.10};  ///< Wrists in front of the shoulders, of upright people.
  /// Elbows in front of the line from shoulder to wrist; of people who are not upright as for
  /// knees, times the size of the cosine once more.
  Cue elbows{-1.49, 0.05};
  Cue lean{0.53, 0.15};  ///< Shoulders in front of the hips, of upright people.
  /// Arm joints that sensors in front of the person see and sensors behind infer; here `at` is a
  /// fraction of these joints.
  Cue hidden{0.5, 0.25};
  /// Toes in front of the ankles, of upright people, in views whose sensor has the toes point
  /// away from itself.  Not learned (decision 0123): in the recordings that may be
  /// shipped people face the sensor.
  Cue feet{2.0, 0.05};
  double same = 5.0;  ///< Time constant of the autocorrelation of postures [s].

  bool operator==(const PostureCues&) const = default;
};

/// Log odds that the left of the person is where `left` (unit, world) points.  Uses all views
/// together, because they see the same posture.  Swapping the labels of a view changes nothing;
/// reversing `left` reverses the sign.  `upright`: see upright_share().
[[nodiscard]] double posture_log_odds(const std::vector<SensorView>& views,
                                      const Eigen::Vector3d& left, double upright,
                                      const PostureCues& cues);

}  // namespace chorus::facing
