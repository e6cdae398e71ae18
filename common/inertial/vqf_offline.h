// VQF over a whole recording, forward and backward, without delay (Laidig and Seel 2023,
// Sect. 3.8).
#pragma once

#include <span>
#include <vector>

#include "common/inertial/imu_sample.h"
#include "common/inertial/vqf.h"

namespace chorus::inertial {

/// East-north-up from sensor for every sample.  The live filter runs forward and backward in time;
/// the bias is the mean of both weighted by their covariances, a field is disturbed where both say
/// so, and tilt and heading are filtered in both directions, so that neither lags.
[[nodiscard]] std::vector<Eigen::Quaterniond> vqf_offline(std::span<const ImuSample> samples,
                                                          double period,
                                                          const VqfOptions& options = {});

}  // namespace chorus::inertial
