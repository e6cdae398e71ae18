// Calibration as in the paper: hand-eye calibration of rotations by Park and Martin (Eqs. 2-12).
//
// F. C. Park, B. J. Martin: Robot sensor calibration: solving AX = XB on the Euclidean group,
// IEEE Trans. Robotics and Automation 10(5), 1994.
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/result.h"
#include "common/evaluation/orientation_pair.h"

namespace chorus::evaluation {

/// Relative rotations of one sensor and its limb between two instants (Eq. 6: A X = X B).
struct RotationPair {
  Eigen::Quaterniond a, b;
};

/// Eqs. (8)-(11): the rotation X with A X = X B for all pairs in least squares.  Deviations: q and
/// -q are one rotation, so w >= 0 before the logarithm; M is inverted by a signed singular value
/// decomposition, which gives no reflection.  Refused unless the axes span a plane.
[[nodiscard]] Result<Eigen::Quaterniond> park_martin(const std::vector<RotationPair>& pairs);

struct ParkOptions {
  std::size_t pairs =
      3000;  ///< Pairs of instants, drawn at random; consecutive ones are all noise.
  std::uint64_t seed = 1;
};

struct ParkCalibration {
  Eigen::Quaterniond world_from_inertial = Eigen::Quaterniond::Identity();  ///< q^G
  Eigen::Quaterniond limb_from_sensor = Eigen::Quaterniond::Identity();     ///< q^L
};

/// q^L by Eq. (5) and q^G by its dual, Eq. (12), each from random pairs of instants.
[[nodiscard]] Result<ParkCalibration> park_calibration(const OrientationPairs& pairs,
                                                       const ParkOptions& options = {});

/// The pairs of Eq. (5), for other solvers: A = conj(q^I(s)) q^I(t), B = conj(q^T(s)) q^T(t).
[[nodiscard]] std::vector<RotationPair> local_pairs(const OrientationPairs& pairs,
                                                    const ParkOptions& options = {});

}  // namespace chorus::evaluation
