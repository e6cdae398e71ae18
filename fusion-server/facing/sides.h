// Which side of a person is which, agreed between all sensors and kept over time (Otto 5.2.2).
//
// A body tracker assumes that everybody faces it: seen from behind, the skeleton is in place but
// left and right are exchanged.  So the vectors left - right of two views either agree or oppose
// each other, which settles the views among themselves.  One common sign remains.  A hidden Markov
// model tracks it from posture, walking and the habits that each sensor has shown, without assuming
// an angle at which trackers exchange sides (docs/papers/sides.md).  Causal: no instant uses later
// ones.
#pragma once

#include <map>

#include "fusion-server/facing/labels.h"
#include "fusion-server/facing/limbs.h"
#include "fusion-server/facing/person_sides.h"
#include "fusion-server/facing/posture.h"
#include "fusion-server/facing/walking.h"

namespace chorus::facing {

struct SidesConfig {
  bool resolve = true;  ///< false: left and right stay as each sensor says.
  PostureCues posture = {};
  WalkingCue walking = {};
  PersonPrior person = {};
  HabitPrior habit = {};
  LimbLimits limbs = {};
  double change_odds = 1.0;  ///< Log odds against the sides held that are needed to change them.
  double smoothing = 0.1;    ///< Time constant with which the sides held follow the views [s].
  double learn_from = 0.95;  ///< Habits are learned only while the sides are at least this certain.
  Duration forget = std::chrono::seconds(1);  ///< A person unseen for this long starts anew.

  bool operator==(const SidesConfig&) const = default;
};

/// What is remembered of one view of a person.
struct SeenLabels {
  Timestamp seen;
  Exchanged exchanged;
};

/// What is remembered of one person.
struct Sides {
  Timestamp seen;
  Spans spans{};  ///< The spans agreed on recently.
  PersonFilter filter;
  Walk walk;
  double posture = 0.0;  ///< Its log odds at the last instant.
  std::map<SensorId, SeenLabels> views;
};

struct SidesMemory {
  std::map<PersonId, Sides> people;
  std::map<SensorId, ExchangeHabit> habits;  ///< From all people that a sensor has seen.
};

/// Exchanges left and right in the views that have them the wrong way round, sets every view's
/// `facing` to that of the agreed body, the person's confidence of sides, and updates `memory`.  An
/// exchanged view loses its orientations, because they are those of a body that faces the sensor.
void resolve_sides(Person& person, Timestamp instant, SidesMemory& memory,
                   const SidesConfig& config);

}  // namespace chorus::facing
