#include "fusion-server/fusion/inverse_variance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "common/geometry/rotation.h"

namespace chorus::fusion {
namespace {

constexpr int kHuberIterations = 8;     // the Huber re-weighting converges in 4-6
constexpr double kHuberSettled = 1e-6;  // [m]

struct WeightedMean {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

WeightedMean solve(std::span<const JointView> views, std::span<const Eigen::Matrix3d> information,
                   std::span<const double> trust) {
  WeightedMean estimate;
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < views.size(); ++i) {
    estimate.information += trust[i] * information[i];
    right += trust[i] * information[i] * views[i].joint.position;
  }
  estimate.position = estimate.information.llt().solve(right);
  return estimate;
}

double huber_weight(double distance, double huber) {
  return distance <= huber || !(huber > 0) ? 1.0 : huber / distance;
}

/// Covariance of the estimate, pose errors included.
Eigen::Matrix3d stated(std::span<const JointView> views, std::span<const double> trust) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Eigen::Matrix3d pose = views[i].pose_variance * Eigen::Matrix3d::Identity();
    information += trust[i] * (views[i].covariance + pose).inverse();
  }
  return information.inverse();
}

Shares shares_of(std::span<const JointView> views, std::span<const Eigen::Matrix3d> information,
                 std::span<const double> trust, const WeightedMean& estimate) {
  const Eigen::Matrix3d spread = estimate.information.inverse();
  ShareTally tally;
  for (std::size_t i = 0; i < views.size(); ++i)
    tally.add(views[i].contributor, trust[i] * pull_of(information[i], spread));
  return tally.shares();
}

FusedJoint finish(std::span<const JointView> views, std::span<const double> trust,
                  const WeightedMean& estimate) {
  FusedJoint fused;
  fused.joint.position = estimate.position;
  fused.joint.state = JointState::Inferred;
  state_covariance(fused, stated(views, trust));
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<double> weights;
  for (std::size_t i = 0; i < views.size(); ++i) {
    fused.joint.state = std::max(fused.joint.state, views[i].joint.state);
    fused.contributors |= views[i].contributor;
    if (!is_unit(views[i].joint.orientation)) continue;
    rotations.push_back(views[i].joint.orientation);
    weights.push_back(trust[i] / mean_variance(views[i].covariance));
  }
  if (!rotations.empty()) fused.joint.orientation = weighted_lerp(rotations, weights);
  return fused;
}

}  // namespace

FusedJoint inverse_variance(std::span<const JointView> views, double huber) {
  if (views.empty()) return {};
  std::vector<Eigen::Matrix3d> information;
  for (const JointView& s : views) information.push_back(s.covariance.inverse());
  std::vector<double> trust(views.size(), 1.0);
  WeightedMean estimate = solve(views, information, trust);
  for (int i = 0; i < kHuberIterations; ++i) {
    for (std::size_t k = 0; k < views.size(); ++k) {
      const Eigen::Vector3d off = views[k].joint.position - estimate.position;
      trust[k] = huber_weight(std::sqrt(off.dot(information[k] * off)), huber);
    }
    const WeightedMean next = solve(views, information, trust);
    const bool settled = (next.position - estimate.position).norm() < kHuberSettled;
    estimate = next;
    if (settled) break;
  }
  FusedJoint fused = finish(views, trust, estimate);
  fused.shares = shares_of(views, information, trust, estimate);
  return fused;
}

}  // namespace chorus::fusion
