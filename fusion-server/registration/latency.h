// The latency of each sensor relative to the others, where clocks are known.
//
// Every pair that has an edge measures the difference of its latencies (pair_latency.h); weighted
// least squares over the network of all pairs, with a prior per sensor, gives one latency each.
// Derived in docs/papers/registration.md, Section 12.
#pragma once

#include <functional>
#include <vector>

#include "fusion-server/flow/latency.h"
#include "fusion-server/registration/time_offset.h"

namespace chorus::registration {

/// One for each sensor whose clock is known; empty if config.latency_sigma is 0, or if no two such
/// sensors share an edge.  `found`: the registration of this walk.
[[nodiscard]] Latencies latencies_of(const std::vector<WalkTrack>& walk, const Registration& found,
                                     const RegistrationConfig& config,
                                     const PairSearch& search = {});

/// What `solve` makes of the walk, and again once the latencies that it shows have been taken off
/// the walk's capture times, if that places as many sensors.
[[nodiscard]] Registration without_latencies(std::vector<WalkTrack>& walk,
                                             const std::function<Registration()>& solve,
                                             const RegistrationConfig& config,
                                             const PairSearch& search = {});

}  // namespace chorus::registration
