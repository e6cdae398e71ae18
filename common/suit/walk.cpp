#include "common/suit/walk.h"

#include <cmath>

namespace chorus::suit {
namespace {

// How the error grows: each metre errs by this, on the ground and in flight, independently of the
// metre before [m per square root of a metre] (docs/benchmarks/positioner.md says what was
// measured).
constexpr double kPerMetre = 0.08;
constexpr double kPerMetreOfFlight = 0.20;
constexpr double kHeightSigma = 0.02;        // Of a standing person [m].
constexpr double kFlightHeightSigma = 0.08;  // [m]

}  // namespace

const Walked& Walk::next(const SuitPose& pose) {
  const Step step = footing_.next(pose);
  if (step.stance == Stance::Unknown) return walked_;
  const bool flies = step.stance == Stance::Flight;
  walked_.place += step.moved;
  walked_.place.y() = step.height;
  walked_.stance = step.stance;
  const double way = step.moved.norm();
  walked_.distance += way;
  const double grown = way * std::pow(flies ? kPerMetreOfFlight : kPerMetre, 2);
  walked_.covariance(0, 0) += grown;
  walked_.covariance(2, 2) += grown;
  walked_.covariance(1, 1) = std::pow(flies ? kFlightHeightSigma : kHeightSigma, 2);
  return walked_;
}

Skeleton<WorldSpace> walked_body(const SuitPose& pose, const Walked& walked, double pose_sigma) {
  Skeleton<WorldSpace> body = placed(pose, 0.0, walked.place);
  const Covariance covariance(
      Eigen::Matrix3d(walked.covariance + pose_sigma * pose_sigma * Eigen::Matrix3d::Identity()));
  for (Joint& joint : body.joints) {
    if (joint.seen()) joint.covariance = covariance;
  }
  return body;
}

}  // namespace chorus::suit
