#include "fusion-server/fusion/weighted_mean.h"

#include <algorithm>
#include <vector>

#include "common/geometry/rotation.h"

namespace chorus::fusion {
namespace {

constexpr double kAxes = 3.0;

/// Mean per-axis variance of one sighting: one axis along the ray, two across.
double axis_variance(const Sighting& sighting) {
  const NoiseModel noise = noise_of(sighting);
  return (noise.along * noise.along + 2.0 * noise.across * noise.across) / kAxes;
}

}  // namespace

FusedJoint weighted_mean(std::span<const Sighting> sightings) {
  double total = 0.0;
  for (const Sighting& s : sightings) total += s.weight > 0 ? s.weight : 0.0;  // drops NaN too
  if (!(total > 0)) return {};
  FusedJoint fused;
  fused.joint.state = JointState::Inferred;
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<double> weights;
  for (const Sighting& s : sightings) {
    if (!(s.weight > 0)) continue;
    const double share = s.weight / total;
    fused.joint.position += share * s.joint.position;
    fused.joint.state = std::max(fused.joint.state, s.joint.state);
    fused.variance += share * share * axis_variance(s);
    fused.contributors |= s.contributor;
    if (!is_unit(s.joint.orientation)) continue;
    rotations.push_back(s.joint.orientation);
    weights.push_back(share);
  }
  if (!rotations.empty()) fused.joint.orientation = weighted_lerp(rotations, weights);
  return fused;
}

}  // namespace chorus::fusion
