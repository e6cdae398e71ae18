// Matches the bodies of all sensors with tracks, and clusters across sensors the bodies that no
// track explains.
//
// Each sensor's bodies are assigned to tracks one-to-one at the lowest total cost, by their
// distance from where the track is expected and from where the other sensors see it, and by what
// inertial sensors on the person say of the limbs.  The sensors
// take turns until nothing changes, for a few rounds at most.  An unmatched body costs as much as
// the farthest allowed match, so that forcing an extra pair never pays.
#pragma once

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

/// Adds each view to the candidate that it fits; returns the views that fit none.
[[nodiscard]] std::vector<PlacedView> match(std::vector<PlacedView> views,
                                            std::vector<Candidate>& candidates);

/// Groups views that are within `limit` [m] of each other, at most one per sensor.
[[nodiscard]] std::vector<std::vector<PlacedView>> cluster(std::vector<PlacedView> views,
                                                           double limit);

[[nodiscard]] bool has_sensor(const std::vector<PlacedView>& views, const SensorId& sensor);

}  // namespace chorus::associate
