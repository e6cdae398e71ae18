// What is known of an inertial source that somebody wears, for people and resources.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/strong_id.h"
#include "common/inertial/limb.h"
#include "common/time/timestamp.h"

namespace chorus {

struct WornSensorReport {
  std::string sensor;
  inertial::Limb limb = inertial::Limb::Pelvis;
  bool calibrated = false;
  std::string refusal;                     ///< Why not, and what to do; empty if it is.
  double prediction_sigma = 0.0;           ///< What it knows its limb to, once calibrated [rad].
  double heading = 0.0;                    ///< Of its space in the world, as followed [rad].
  double heading_sigma = 0.0;              ///< [rad]
  std::optional<double> slipped_ago = {};  ///< Time since it last turned on its limb [s].
  double slip = 0.0;                       ///< By how much [rad].
  /// While other sensors of its source speak: since it last did [s].
  std::optional<double> silent_for = {};
  /// What it states of its own error, where that leaves it no say [rad].
  std::optional<double> overstated = {};
};

struct WornReport {
  SensorId source;
  std::optional<PersonId> wearer = {};
  std::string reason;  ///< Why nobody is known to wear it; empty if somebody is.
  std::vector<WornSensorReport> sensors = {};
  std::vector<std::string> unplaced = {};  ///< Sensors whose limb nobody has told.
};

}  // namespace chorus
