#include "fusion-server/fusion/view_score.h"

#include <algorithm>
#include <cmath>

namespace chorus::fusion {

long tracked_joints(const SensorView& view) {
  return std::ranges::count(view.skeleton.joints, JointState::Tracked, &Joint::state);
}

double view_score(const SensorView& view) {
  const double tracked = static_cast<double>(tracked_joints(view)) / kJointCount;
  const double squarely = std::isfinite(view.facing) ? std::cos(view.facing) : 0.0;
  return tracked + 0.5 * (1.0 + squarely);
}

}  // namespace chorus::fusion
