#include "common/body/guessed_depth.h"

#include <cmath>

namespace chorus {
namespace {

constexpr double kGuessedShare = 0.04;  // of the distance; depth sensors state less than 2 %
constexpr double kGuessedRatio = 3.0;   // along to across; of depth sensors at most 2

}  // namespace

bool has_guessed_depth(const Joint& joint, const Eigen::Vector3d& eye) {
  const Eigen::Vector3d way = joint.position - eye;
  const double range = way.norm();
  if (!joint.covariance.known() || !(range > 0.0)) return false;
  const Eigen::Vector3d ray = way / range;
  const Eigen::Matrix3d error = joint.covariance.matrix();
  const double along = ray.dot(error * ray);
  const double across = 0.5 * (error.trace() - along);
  return along >= std::pow(kGuessedShare * range, 2) &&
         along >= kGuessedRatio * kGuessedRatio * across;
}

}  // namespace chorus
