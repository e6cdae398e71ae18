// Judges by worn inertial sensors which side of a person is the left one.
//
// A calibrated sensor on the left forearm knows where that forearm points: as far as the right one
// points elsewhere, it tells which is which.  Sensors on pelvis and chest know where the front is.
// The sensors are one more witness beside posture, walking and labels, and one that may be wrong
// for long: on the other limb than it says, or calibrated while the sides were wrong.
#pragma once

#include <span>
#include <vector>

#include "fusion-server/facing/stand_in.h"
#include "fusion-server/flow/person.h"

namespace chorus::facing {

struct WornCue {
  /// Chance that the sensors mislead, all together: limits their log odds to 3.9.  Not learned: no
  /// recording has sensors on wrong limbs.
  double misleads = 0.02;
  double same = 5.0;  ///< Time constant of the autocorrelation, as that of postures [s].

  bool operator==(const WornCue&) const = default;
};

/// Log odds that the held sides are right, by Person::worn; 0 without.  `exchanged`: for each view,
/// whether it opposes the held sides; `flat`: the views that are flat figures.
[[nodiscard]] double worn_log_odds(const Person& person, const std::vector<bool>& exchanged,
                                   std::span<const Figure> flat, const WornCue& cue);

}  // namespace chorus::facing
