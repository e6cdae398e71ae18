// What association is told: how far apart, how long, how wide.
#pragma once

#include "common/base/units.h"
#include "common/time/timestamp.h"
#include "fusion-server/associate/plausible.h"

namespace chorus::associate {

struct AssociationConfig {
  double gate = 0.6;         ///< Core-joint distance beyond which a body is not this person [m].
  double gate_growth = 0.3;  ///< What is added to it per second without a view [m/s].
  double cluster = 0.4;  ///< New bodies of different sensors closer than this are one person [m].
  double ray_cluster = 0.15;  ///< New people: rays of different cameras pass this close [m].
  int confirm_frames = 3;     ///< Instants a new person is seen before it is published.
  Duration coast = std::chrono::seconds(3);  ///< How long somebody without any view is looked for.
  /// How long somebody without any view is answered where they are expected.
  Duration carry = std::chrono::seconds(1);
  /// In which time the speed falls to 1/e at which they are expected to go on.
  Duration slow_down = std::chrono::seconds(2);
  /// How long somebody who left is known again by their build; 0: not at all.
  Duration remember = std::chrono::seconds(60);
  /// How long a newcomer is looked at before it is said who of those who left it is.
  Duration recognise = std::chrono::seconds(1);
  /// Whoever comes back into sight after this long is held against who they were.
  Duration question = std::chrono::milliseconds(200);
  /// Two confirmed tracks merge after this many instants on one spot without a common sensor.
  int merge_frames = 15;
  /// How long a body of one sensor waits once others have looked there and seen nobody; 0: not at
  /// all.  While others see through it from two sides, it waits on.
  Duration alone = std::chrono::seconds(3);
  /// A sensor surely sees a person this close to its optical axis [rad] and this near [m].
  double look_angle = deg(25);
  double look_range = 4.0;
  BodyLimits bodies = {};

  bool operator==(const AssociationConfig&) const = default;
};

}  // namespace chorus::associate
