// Which sensors tell front from rear, and what their labels then say about the held sides, which
// are those that a person is currently assumed to have (labels.h; docs/papers/sides.md, Labels).
//
// A tracker that takes everybody for facing it shows a person and the mirror image the same labels,
// so that its labels say nothing about the sides.  A network that finds joints in pictures names
// left and right correctly from behind, too, apart from short mistakes; then every view is evidence
// at every instant.  What a sensor does is learned from how it labels people who turn their backs
// on it while their sides are certain.
#pragma once

#include "common/base/units.h"
#include "fusion-server/facing/exchange_habit.h"

namespace chorus::facing {

struct TellingPrior {
  /// Beyond this angle to the sensor somebody turns their back on it [rad].
  double from = deg(135);
  double log_odds = 2.2;  ///< Evidence of `time` seconds of right labels there.
  double time = 1.0;      ///< [s]
  double limit = 4.6;     ///< Of the log odds of a sensor.
  /// Share of the time in which a sensor that tells front from rear is wrong nevertheless.
  double mistaken = 0.03;
  double same = 1.0;  ///< Time constant of the autocorrelation of its mistakes [s].

  bool operator==(const TellingPrior&) const = default;
};

/// Log odds that one sensor tells front from rear; 0 while nothing is known.
class Telling {
 public:
  /// Call this only while the held sides are certain.
  void learn(const Passage& passage, const TellingPrior& prior);
  [[nodiscard]] double log_odds() const { return log_odds_; }

 private:
  double log_odds_ = 0.0;
};

/// Log odds that the held sides are right, from the labels of one view at one instant; `agree`: log
/// odds that the view agrees with them.  Zero unless the sensor is known to tell front from rear.
[[nodiscard]] double sight_log_odds(double agree, const Telling& telling,
                                    const TellingPrior& prior);

/// Log odds that the labels of a sensor are right before they are looked at; 0 unless the sensor is
/// known to tell front from rear.
[[nodiscard]] double usual_log_odds(const Telling& telling, const TellingPrior& prior);

}  // namespace chorus::facing
