// Normal equations of small motions, and the part that two floors contribute
// (docs/papers/registration.md, Section 6).
#pragma once

#include <numbers>

#include "common/base/units.h"
#include "fusion-server/registration/adjoint.h"

namespace chorus::registration {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Row6 = Eigen::Matrix<double, 1, 6>;

/// information * (omega, tau) = right, for a motion applied on the target side.
struct Normal {
  Matrix6 information = Matrix6::Zero();
  Vector6 right = Vector6::Zero();

  void add(const Row6& row, double residual, double weight);
};

/// Standard deviations between two levelled frames: of pitch and roll (tilt [rad], per axis) and of
/// height [m]; 0: no prior.
struct FloorPrior {
  double tilt = 0.0;
  double height = 0.0;
};

inline constexpr FloorPrior kOneFloor{deg(0.4), mm(10)};

/// A floor that was guessed from bodies.  What is wrong with it is common to all places, which are
/// known relative to each other: it is told once, and in no sensor's covariance.
inline constexpr FloorPrior kGuessedFloor{deg(2), mm(50)};

/// The difference of two floors is less certain by sqrt(2).
inline constexpr FloorPrior kTwoFloors{kOneFloor.tilt * std::numbers::sqrt2,
                                       kOneFloor.height* std::numbers::sqrt2};

/// Adds the prior: because both frames are levelled, a motion must neither tilt the vertical nor
/// lift the floor below the walk.
void add_prior(Normal& normal, const FloorPrior& prior, const Eigen::Isometry3d& target_from_source,
               const Eigen::Vector3d& centre_in_source);

}  // namespace chorus::registration
