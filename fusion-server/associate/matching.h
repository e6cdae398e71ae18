// Which body of which sensor is which track, and which bodies of different sensors are one
// newcomer.
//
// The total cost over all sensors is made least, each body that nobody gets costing as much as the
// farthest that somebody could: a pair too many is no better than a pair too bad.  A sensor's
// bodies are assigned one-to-one, by their distance from where a track is expected and from where
// the other sensors show it, in turn until nothing changes.
#pragma once

#include "fusion-server/associate/association_config.h"
#include "fusion-server/associate/track.h"

namespace chorus::associate {

/// Hands the views to the candidates; returns those that fit none.
[[nodiscard]] std::vector<PlacedView> match(std::vector<PlacedView> views,
                                            std::vector<Candidate>& candidates);

/// Views within `limit` [m] of each other, none of the same sensor.
[[nodiscard]] std::vector<std::vector<PlacedView>> cluster(std::vector<PlacedView> views,
                                                           double limit);

[[nodiscard]] bool has_sensor(const std::vector<PlacedView>& views, const SensorId& sensor);

}  // namespace chorus::associate
