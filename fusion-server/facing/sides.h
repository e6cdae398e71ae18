// Which side of a person is which, agreed between all sensors and kept over time (Otto 5.2.2).
//
// A body tracker believes that everybody faces it: seen from behind, the skeleton is in place but
// left and right are exchanged.  Joint pairs as vectors left - right therefore agree between two
// views or point against each other, which settles the views among themselves.  What is left is one
// sign for all of them, followed as log odds: people turn slowly, mostly walk forwards, and a
// tracker that exchanges sides does so from well behind the side view only.
//
// Only relative evidence for a lone sensor that never saw the person walk: it may stay wrong.
#pragma once

#include <array>
#include <map>
#include <optional>

#include "common/base/units.h"
#include "fusion-server/flow.h"

namespace chorus::facing {

struct SidesConfig {
  bool resolve = true;  ///< false: left and right are what each sensor says.
  /// |phi| at which a tracker has exchanged sides in half of the cases [rad]: between 130 deg going
  /// and 100 deg coming back (Otto Fig. 6), and how gradually.
  double exchange_at = deg(115);
  double exchange_width = deg(10);
  double exception = 0.05;     ///< Share of views that do otherwise, far from exchange_at.
  double walking_speed = 0.4;  ///< From here on the way says where the front is [m/s].
  double backwards = 0.05;     ///< Share of walking that is backwards.
  double smoothing = 0.1;      ///< Time over which the sides held follow the views [s].
  double memory = 0.5;         ///< Evidence within so much time is the same evidence [s].
  double most_odds = 6.0;      ///< Log odds are kept within +- this.
  double change_odds = 1.0;    ///< Against the sides held, before they change.
  Duration forget = std::chrono::seconds(1);  ///< A person unseen for so long begins anew.

  bool operator==(const SidesConfig&) const = default;
};

/// Pairs whose direction tells the sides, trunk first.
inline constexpr std::array<JointId, 6> kSidePairs{JointId::ShoulderLeft, JointId::HipLeft,
                                                   JointId::ElbowLeft,    JointId::KneeLeft,
                                                   JointId::WristLeft,    JointId::AnkleLeft};

/// Left minus right of each pair, world [m]; zero where the pair is not seen.
using Spans = std::array<Eigen::Vector3d, kSidePairs.size()>;

/// What is remembered of one person.
struct Sides {
  Timestamp seen;
  Spans spans{};      ///< As agreed lately.
  double odds = 0.0;  ///< Log odds that they are right.
};

using SidesMemory = std::map<PersonId, Sides>;

struct Motion {
  Timestamp instant;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< Of the person, world [m/s].
};

/// Exchanges left and right in the views that have them the wrong way round, sets every view's
/// `facing` to that of the agreed body, and remembers.  A view that was exchanged loses its
/// orientations: they are those of a body that faces the sensor.
void resolve_sides(Person& person, const Motion& motion, SidesMemory& memory,
                   const SidesConfig& config);

}  // namespace chorus::facing
