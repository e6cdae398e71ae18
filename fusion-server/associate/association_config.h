// The parameters of association: distances, times, angles.
#pragma once

#include "common/base/units.h"
#include "common/time/timestamp.h"
#include "fusion-server/associate/plausible.h"

namespace chorus::associate {

struct AssociationConfig {
  /// A body is not taken for a person who is expected farther away from it than this [m], measured
  /// horizontally; where sensors state large errors, the limit is greater.
  double gate = 0.6;
  double gate_growth = 0.3;  ///< The gate grows by this for every second without a view [m/s].
  double cluster = 0.4;  ///< New bodies of different sensors closer than this are one person [m].
  /// Rays of different cameras can start a new person if they pass each other closer than this [m].
  double ray_cluster = 0.15;
  int confirm_frames = 3;  ///< Number of instants with a view before a new person is published.
  Duration coast = std::chrono::seconds(3);  ///< How long an unseen published person is looked for.
  /// How long an unseen person is still published, at the place where they are expected.
  Duration carry = std::chrono::seconds(1);
  /// Time constant with which the predicted speed of an unseen person decays.
  Duration slow_down = std::chrono::seconds(2);
  /// How long a person who left can be recognised by their build; 0: not at all.
  Duration remember = std::chrono::seconds(60);
  /// Two published tracks merge after this many consecutive instants at the same spot without a
  /// common sensor.
  int merge_frames = 15;
  /// How long a body must persist where sensors contradict each other so evenly that it would be
  /// believed if it moved; less if it moves. 0: it need not wait.
  Duration doubt = std::chrono::seconds(10);
  BodyLimits bodies = {};

  bool operator==(const AssociationConfig&) const = default;
};

}  // namespace chorus::associate
