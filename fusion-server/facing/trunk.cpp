#include "fusion-server/facing/trunk.h"

#include <algorithm>
#include <cmath>

namespace chorus::facing {

Eigen::Vector3d trunk_of(const std::vector<SensorView>& views) {
  constexpr double kShortest = 0.1;  // [m]; a shorter mean shows no direction.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SensorView& view : views) {
    const Joint& upper = view.skeleton[JointId::SpineShoulder];
    const Joint& lower = view.skeleton[JointId::SpineBase];
    if (upper.seen() && lower.seen()) sum += upper.position - lower.position;
  }
  return sum.norm() < kShortest ? Eigen::Vector3d::UnitY() : sum.normalized();
}

double upright_share(const Eigen::Vector3d& trunk, const UprightRange& range) {
  const double none = std::cos(range.none);
  const double full = std::cos(range.full);
  return std::clamp((trunk.y() - none) / std::max(full - none, 1e-9), 0.0, 1.0);
}

}  // namespace chorus::facing
