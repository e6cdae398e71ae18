// Computes one edge of the graph from two trails.
#pragma once

#include <functional>
#include <vector>

#include "fusion-server/registration/floor_constraint.h"
#include "fusion-server/registration/trail.h"

namespace chorus::registration {

/// One sensor's walk, with everything that is computed once per sensor.
struct Walker {
  Trail trail;
  WalkFloor floor;
};

[[nodiscard]] Walker walker_of(const WalkTrack& walk, const RegistrationConfig& config);

/// Errors: NotFound, the two sensors never saw the person together; Unavailable, what they saw does
/// not determine the edge; Conflict, their views are inconsistent.
[[nodiscard]] Result<PairwiseRegistration> register_walkers(const Walker& target,
                                                            const Walker& source,
                                                            const RegistrationConfig& config);

/// Estimates an edge from two walks.
using PairEstimator = std::function<Result<PairwiseRegistration>(const Walker&, const Walker&)>;

/// Asked now and then during long work; once it returns true, the result is of no use to anybody.
using Stopped = std::function<bool()>;

/// What solve() does once the clocks are in step, but with `estimate` for the edges.
[[nodiscard]] Registration solve_with(const PairEstimator& estimate,
                                      const std::vector<WalkTrack>& walk, Timestamp now,
                                      const RegistrationConfig& config,
                                      const Stopped& stopped = {});

}  // namespace chorus::registration
