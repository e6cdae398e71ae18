// Other ways to make an edge out of two walks, to stand beside ours.  They get the same frames, the
// same floor planes, the same refusals (too little in common, too narrow, too far apart) and the
// same world around them (registration::solve_with).
#pragma once

#include "fusion-server/registration/pair_registration.h"

namespace chorus::bench {

/// ICP on the neck trails of the time both saw somebody, time being a fourth coordinate, 1 s
/// counting as 1 m: the nearest neighbour is near in space and in time.  As the untimed baseline:
/// levelled, from 24 yaws, the best 90 % of the correspondences, height from the floor.
[[nodiscard]] registration::PairEstimator trajectory_icp(
    const registration::RegistrationConfig& config);

/// Time-interpolated pairs and one weighted least-squares fit: no robustness, no refinement.
[[nodiscard]] registration::PairEstimator closed_form(
    const registration::RegistrationConfig& config);

}  // namespace chorus::bench
