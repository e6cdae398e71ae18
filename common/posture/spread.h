// How far the measures of a posture may be wrong, from the covariances of its joints.
//
// Errors of different joints are taken as independent, as fusion states them.  Joints without a
// covariance count as exact; `doubtless` says how many there were.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "common/body/skeleton.h"
#include "common/posture/posture.h"

namespace chorus::posture {

using MeasureCovariance = Eigen::Matrix<double, kMeasures, kMeasures>;

struct Spread {
  /// NaN in the rows of measures that are undefined at the body or next to it.
  MeasureCovariance covariance = MeasureCovariance::Zero();
  std::size_t doubtless = 0;
};

/// Covariance of the measures by the sigma-point transform of second order (Norgaard, Poulsen &
/// Ravn 2000, Eqs. 26-27): two points for each joint and axis, sqrt(3) standard deviations away.
[[nodiscard]] Spread spread_of(const Skeleton<WorldSpace>& body);

/// How many bodies stand for the doubt about one.  With 32, a probability of 0.9 is known to 0.05.
inline constexpr std::size_t kDraws = 32;

/// What a head's orientation from nose, eyes and ears errs by [rad]: marks that are each 10 mm off
/// on levers of 7 to 9 cm.
inline constexpr double kHeadTurn = 0.14;

/// The measures of kDraws bodies, drawn from the covariances about this one.  The deviates are the
/// same at every call, in pairs of opposite sign, so equal bodies have equal answers.
struct DrawnMeasures {
  std::array<Measures, kDraws> draws;
  std::size_t doubtless = 0;  ///< Seen joints without a covariance.
};
/// `share` of the stated standard deviations of the joints is drawn.  A head whose orientation is
/// stated errs by kHeadTurn about each axis.
[[nodiscard]] DrawnMeasures drawn_measures(const Skeleton<WorldSpace>& body, double share = 1.0);

/// The orientation of the head if the body states one; then posture_of() takes it.
[[nodiscard]] std::optional<Eigen::Quaterniond> head_of(const Skeleton<WorldSpace>& body);

/// posture_of() of a body as it stands.
[[nodiscard]] Posture posture_of(const Skeleton<WorldSpace>& body);

}  // namespace chorus::posture
