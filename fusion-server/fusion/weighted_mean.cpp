#include "fusion-server/fusion/weighted_mean.h"

#include <algorithm>
#include <vector>

#include "common/geometry/rotation.h"

namespace chorus::fusion {
FusedJoint weighted_mean(std::span<const JointView> views) {
  double total = 0.0;
  for (const JointView& s : views) total += s.weight > 0 ? s.weight : 0.0;  // skips NaN too
  if (!(total > 0)) return {};
  FusedJoint fused;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  fused.joint.state = JointState::Inferred;
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<double> weights;
  ShareTally tally;
  for (const JointView& s : views) {
    if (!(s.weight > 0)) continue;
    const double share = s.weight / total;
    fused.joint.position += share * s.joint.position;
    fused.joint.state = std::max(fused.joint.state, s.joint.state);
    covariance += share * share * s.covariance;
    fused.contributors |= s.contributor;
    tally.add(s.contributor, share);
    if (!is_unit(s.joint.orientation)) continue;
    rotations.push_back(s.joint.orientation);
    weights.push_back(share);
  }
  fused.shares = tally.shares();
  state_covariance(fused, covariance);
  if (!rotations.empty()) fused.joint.orientation = weighted_lerp(rotations, weights);
  return fused;
}

}  // namespace chorus::fusion
