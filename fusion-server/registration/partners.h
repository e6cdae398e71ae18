// Which pairs of sensors are registered directly.
//
// Pairs grow with the square of the sensors, and of many sensors that see the same walk most say
// what others have said.  Up to twelve sensors all pairs are tried.  Of more, each sensor has the
// eight partners with which it shares the longest part of the walk; groups that these leave apart
// are joined by all pairs between them.  The last adjustment uses the sights of all sensors either
// way.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "fusion-server/registration/pair_registration.h"

namespace chorus::registration {

/// Target and source of every pair to try, each once, target before source, in ascending order.
/// Pairs that never saw the person together are among them: to find that out costs little, and the
/// reason is told.
[[nodiscard]] std::vector<std::pair<SensorId, SensorId>> partners_of(
    const std::map<SensorId, Walker>& walkers);

}  // namespace chorus::registration
