// From two trails to one edge of the graph.
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

/// Error codes: NotFound, the two never saw the person together; Unavailable, they saw too little;
/// Conflict, what they saw does not fit together.
[[nodiscard]] Result<PairwiseRegistration> register_walkers(const Walker& target,
                                                            const Walker& source,
                                                            const RegistrationConfig& config);

/// Estimates an edge from two walks.
using PairEstimator = std::function<Result<PairwiseRegistration>(const Walker&, const Walker&)>;

/// solve() with another estimator of pairs and everything else the same, so that estimators can be
/// compared.
[[nodiscard]] Registration solve_with(const PairEstimator& estimate,
                                      const std::vector<WalkTrack>& walk, Timestamp now,
                                      const RegistrationConfig& config);

}  // namespace chorus::registration
