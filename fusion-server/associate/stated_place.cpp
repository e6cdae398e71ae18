#include "fusion-server/associate/stated_place.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/body/bones.h"

namespace chorus::associate {
namespace {

constexpr double kDeviations = 3.0;  // Standard deviations that extend a limit.
// [m]; added to the stated errors: the cores of two views of one person differ by about this much.
constexpr double kUnstated = 0.1;

PlanError unstated() { return kUnstated * kUnstated * PlanError::Identity(); }

}  // namespace

double horizontal_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::hypot(a.x() - b.x(), a.z() - b.z());
}

double horizontal_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const PlanError& error, double limit) {
  if (error.isZero() || !(limit > 0)) return horizontal_distance(a, b);
  const Eigen::Vector2d apart = on_floor(a) - on_floor(b);
  const double reach = kDeviations / limit;
  const PlanError stretched = PlanError::Identity() + reach * reach * error;
  return std::sqrt(std::max(0.0, apart.dot(stretched.inverse() * apart)));
}

PlanError stated_error(const Skeleton<WorldSpace>& body) {
  PlanError sum = PlanError::Zero();
  double count = 0.0;
  for (const JointId id : kCoreJoints) {
    const Joint& joint = body[id];
    if (!joint.seen()) continue;
    const Eigen::Matrix3d all = joint.covariance.matrix();
    PlanError plan;
    plan << all(0, 0), all(0, 2), all(2, 0), all(2, 2);
    sum += plan;
    count += 1.0;
  }
  return count > 0 ? PlanError(sum / count) : PlanError::Zero();
}

void MeanPlace::add(const Eigen::Vector3d& place, const PlanError& error) {
  const Eigen::Matrix2d weight = (error + unstated()).inverse();
  weight_ += weight;
  weighted_ += weight * on_floor(place);
  height_ += place.y();
  count_ += 1.0;
}

Eigen::Vector3d MeanPlace::place() const {
  const Eigen::Vector2d plan = weight_.inverse() * weighted_;
  return {plan.x(), height_ / count_, plan.y()};
}

PlanError MeanPlace::error() const {
  if (empty()) return PlanError::Zero();
  const PlanError left = weight_.inverse() - unstated() / count_;
  // Rounding must not state an error where nothing was stated.
  constexpr double kNothing = 1e-9;  // [m^2]
  return left.norm() < kNothing ? PlanError::Zero() : left;
}

}  // namespace chorus::associate
