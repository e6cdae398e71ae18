// Which pairs of sensors are registered directly.
//
// The number of pairs grows with the square of the number of sensors, and where many sensors see
// the same walk, most pairs add nothing new.  Up to twelve sensors all pairs are tried.  With more
// sensors, each is paired with the eight with which it shares the longest part of the walk; groups
// that these pairs leave unconnected are joined by all pairs between them.  In either case the
// final adjustment uses the views of all sensors.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "fusion-server/registration/pair_registration.h"

namespace chorus::registration {

using SensorPair = std::pair<SensorId, SensorId>;  ///< Target and source.

/// Target and source of every pair to try, each once, target before source, in ascending order.
/// Pairs that never saw the person together are included: finding that out costs little, and the
/// reason is reported.
[[nodiscard]] std::vector<SensorPair> partners_of(const std::map<SensorId, Walker>& walkers);

/// The pairs that were not `tried` and lie between groups of sensors that `edges` leave
/// unconnected; there are some if pairs that were chosen have been refused.  Same order as
/// partners_of().
[[nodiscard]] std::vector<SensorPair> untried_links(const std::map<SensorId, Walker>& walkers,
                                                    const std::vector<SensorPair>& tried,
                                                    const std::vector<PairwiseRegistration>& edges);

}  // namespace chorus::registration
