// How well a solve places each sensor, by itself and compared with the registration in use.
#pragma once

#include <vector>

#include "fusion-server/flow/registration.h"
#include "fusion-server/status/registration_progress.h"
#include "fusion-server/status/session_status.h"

namespace chorus::core {

/// How well this solve places each sensor that took part in the walk.
[[nodiscard]] std::vector<SensorAccuracy> accuracy_of(const Registration& candidate);

/// Whether the walk could end here: the candidate is good, it places all sensors that are placed
/// now, and every sensor that took part has a place known to within `target` [m].  If `target` is
/// zero: never.
[[nodiscard]] bool accurate_enough(const Registration& candidate, const Registration& current,
                                   double target);

/// What changes for each sensor that has a place in either registration, if `proposed` replaces
/// `used`.  Both are in the same world.
[[nodiscard]] std::vector<PlaceChange> place_changes(const Registration& used,
                                                     const Registration& proposed);

}  // namespace chorus::core
