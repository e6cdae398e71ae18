// Other ways to compute an edge from two walks, for comparison with ours.  They get the same frames
// and floor planes, and the same code uses their edges (registration::solve_with).  Like ours they
// refuse walks with too little in common, too narrow walks and edges with a large rms.
#pragma once

#include "fusion-server/registration/pair_registration.h"

namespace chorus::bench {

/// ICP on the neck trails while both saw a body, with time as a fourth coordinate, 1 s counting as
/// 1 m: so the nearest neighbour is near in space and time.  Otherwise like the untimed baseline:
/// levelled, from 24 yaws, the best 90 % of correspondences, height from the floor.
[[nodiscard]] registration::PairEstimator trajectory_icp(
    const registration::RegistrationConfig& config);

/// Time-interpolated pairs and one weighted least-squares fit: no robustness, no refinement.
[[nodiscard]] registration::PairEstimator closed_form(
    const registration::RegistrationConfig& config);

}  // namespace chorus::bench
