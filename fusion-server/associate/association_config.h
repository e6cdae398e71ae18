// The parameters of association: distances, times, angles.
#pragma once

#include "common/base/units.h"
#include "common/time/timestamp.h"
#include "fusion-server/associate/plausible.h"

namespace chorus::associate {

struct AssociationConfig {
  double gate = 0.6;          ///< Core joints farther apart [m]: the body is not this person.
  double gate_growth = 0.3;   ///< Growth of the gate per second without a view [m/s].
  double cluster = 0.4;       ///< New bodies of different sensors this close are one person [m].
  double ray_cluster = 0.15;  ///< New people: rays of different cameras pass this close [m].
  int confirm_frames = 3;     ///< Instants a new person is seen before it is published.
  Duration coast = std::chrono::seconds(3);  ///< How long an unseen person is looked for.
  /// How long an unseen person is published where they are expected.
  Duration carry = std::chrono::seconds(1);
  /// Time constant with which the predicted speed of an unseen person decays.
  Duration slow_down = std::chrono::seconds(2);
  /// How long people who left can be recognised by their build; 0: not at all.
  Duration remember = std::chrono::seconds(60);
  /// How long a newcomer is observed before it is decided which missing person it is, if any.
  Duration recognise = std::chrono::seconds(1);
  /// A person seen again after at least this long is compared with who they were.
  Duration question = std::chrono::milliseconds(200);
  /// Two confirmed tracks merge after this many instants on one spot without a common sensor.
  int merge_frames = 15;
  /// How long a body seen by only one sensor must persist if others look there and see nobody; 0:
  /// no wait.  While others see through it from two sides, it goes on waiting.
  Duration alone = std::chrono::seconds(3);
  /// A sensor surely sees a person this close to its optical axis [rad] and this near [m].
  double look_angle = deg(25);
  double look_range = 4.0;
  BodyLimits bodies = {};

  bool operator==(const AssociationConfig&) const = default;
};

}  // namespace chorus::associate
