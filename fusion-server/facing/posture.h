// Where the front of a body is, from its posture alone: exchanging left and right changes nothing
// here (docs/papers/sides.md, Posture).
//
// Knees bend forwards, elbows backwards, hands work in front of the shoulders, and people bend
// forwards.  Feet and heads are not used: seen from behind, a body tracker draws them towards
// itself.
#pragma once

#include <vector>

#include "fusion-server/flow.h"

namespace chorus::facing {

/// Log odds for "ahead is the front": proportional up to `at` metres, constant beyond.
struct Cue {
  double log_odds = 0.0;
  double at = 0.05;  ///< [m]

  bool operator==(const Cue&) const = default;
};

/// Learned from recordings of people who face one sensor, by tests/learn/posture_weights.py.
struct PostureCues {
  Cue knees{1.39, 0.05};    ///< Knees ahead of the line from hip to ankle.
  Cue wrists{1.64, 0.10};   ///< Wrists ahead of the shoulders.
  Cue elbows{-1.49, 0.05};  ///< Elbows ahead of the line from shoulder to wrist.
  Cue lean{0.56, 0.15};     ///< Shoulders ahead of the hips.
  /// Arms that sensors in front of the person see and sensors behind guess; `at` is a share of
  /// joints.
  Cue hidden{0.5, 0.25};
  double same = 5.0;  ///< Time constant within which a posture counts as the same one [s].

  bool operator==(const PostureCues&) const = default;
};

/// Log odds that the front is where `forward` (unit, horizontal) points, from all views together,
/// because they see one posture.  Exchanging the labels of a view changes nothing; reversing
/// `forward` changes the sign.
[[nodiscard]] double posture_log_odds(const std::vector<SensorView>& views,
                                      const Eigen::Vector3d& forward, const PostureCues& cues);

/// What a posture tells that the one `elapsed` seconds before did not, in log odds: the error of a
/// posture lasts as long as the posture (first-order autoregressive, time constant `same`).
[[nodiscard]] double posture_news(double now, double before, double elapsed, double same);

}  // namespace chorus::facing
