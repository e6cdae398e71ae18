// Matches the bodies of all sensors with tracks, and clusters the bodies of newcomers across
// sensors.
//
// Minimises the total cost over all sensors, in which an unmatched body costs as much as the
// farthest allowed match: an extra pair is no better than a bad one.  Each sensor's bodies are
// assigned one-to-one, by their distance from the expected place of a track and from where the
// other sensors see it; sensor by sensor, until nothing changes.
#pragma once

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

/// Adds the views to the candidates they fit; returns those that fit none.
[[nodiscard]] std::vector<PlacedView> match(std::vector<PlacedView> views,
                                            std::vector<Candidate>& candidates);

/// Groups of views within `limit` [m] of each other, at most one per sensor.
[[nodiscard]] std::vector<std::vector<PlacedView>> cluster(std::vector<PlacedView> views,
                                                           double limit);

[[nodiscard]] bool has_sensor(const std::vector<PlacedView>& views, const SensorId& sensor);

}  // namespace chorus::associate
