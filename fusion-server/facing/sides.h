// Decides which side of a person is the left one, from all sensors and over time (Otto 5.2.2).
//
// A body tracker assumes that everybody faces it: for a person seen from behind, the skeleton is in
// place, but left and right are swapped.  So the vectors left - right of two views either agree or
// oppose each other, which resolves the views relative to one another.  One common sign remains
// open.  A hidden Markov model estimates it from posture, walking, worn inertial sensors and the
// learned habits of each sensor, without assuming an angle at which trackers swap sides
// (docs/papers/sides.md).  Causal: the result for an instant does not depend on later ones.
#pragma once

#include <map>
#include <span>

#include "fusion-server/facing/labels.h"
#include "fusion-server/facing/limbs.h"
#include "fusion-server/facing/person_sides.h"
#include "fusion-server/facing/posture.h"
#include "fusion-server/facing/shoulder_sides.h"
#include "fusion-server/facing/stand_in.h"
#include "fusion-server/facing/telling.h"
#include "fusion-server/facing/walking.h"
#include "fusion-server/facing/worn_sides.h"

namespace chorus::facing {

enum class SidesBy {
  Evidence,  ///< All sensors and all evidence, the model of this file.
  Shoulders  ///< Each sensor by itself, as Otto 5.2.2, for comparison: shoulder_sides.h.
};

struct SidesConfig {
  bool resolve = true;  ///< False: left and right stay as the sensors give them.
  SidesBy by = SidesBy::Evidence;
  PostureCues posture = {};
  WalkingCue walking = {};
  UprightRange upright = {};
  PersonPrior person = {};
  HabitPrior habit = {};
  TellingPrior telling = {};
  WornCue worn = {};
  LimbLimits limbs = {};
  double change_odds = 1.0;  ///< The held sides change if the log odds against them exceed this.
  /// Standard deviation of the angle between the held spans and those on which the views agree, of
  /// people who turn [rad].
  double turn_sigma = deg(50);
  double smoothing = 0.1;    ///< Time constant with which the held spans follow the views [s].
  double learn_from = 0.95;  ///< Habits are learned while the sides are at least this probable.
  /// A person who was not seen for this long is forgotten.
  Duration forget = std::chrono::seconds(1);

  bool operator==(const SidesConfig&) const = default;
};

/// What is remembered about one view of a person.
struct SeenLabels {
  Timestamp seen;
  Exchanged exchanged;
};

/// What is remembered about one person.
struct Sides {
  Timestamp seen;
  Spans spans{};  ///< The spans on which the views agreed recently.
  PersonFilter filter;
  Walk walk;
  double posture = 0.0;  ///< Log odds of the posture at the previous instant.
  double sight = 0.0;    ///< Log odds of the labels at the previous instant.
  double worn = 0.0;     ///< Log odds of worn sensors at the previous instant.
  std::map<SensorId, SeenLabels> views;
};

struct SidesMemory {
  std::map<PersonId, Sides> people;
  // Learned from all people whom the sensor saw.
  std::map<SensorId, ExchangeHabit> habits;
  std::map<SensorId, Telling> telling;
  ShoulderMemory shoulders;
};

/// Swaps left and right in the views that have them wrong, calls mend_limbs(), sets each view's
/// `facing` to that of the agreed body if that is known, sets the person's sides_confidence, and
/// updates `memory`. Does nothing without config.resolve or without views. A swapped view loses its
/// orientations, because they describe a body that faces the sensor.  `flat`: the views that are
/// flat figures.
void resolve_sides(Person& person, Timestamp instant, SidesMemory& memory,
                   const SidesConfig& config, std::span<const Figure> flat = {});

}  // namespace chorus::facing
