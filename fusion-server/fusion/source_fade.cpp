#include "fusion-server/fusion/source_fade.h"

#include <cmath>

#include "fusion-server/fusion/joint_view.h"

namespace chorus::fusion {
namespace {

constexpr double kSourceFading = 0.15;  // [s]
constexpr double kNoOffset = 1e-6;      // [m]

}  // namespace

void SourceFade::apply(FusedBody& body, const PlacedBody& expected, bool changed, double passed) {
  const double kept = std::exp(-passed / kSourceFading);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Eigen::Vector3d& offset = offsets_[j];
    offset *= kept;
    Joint& joint = body.skeleton.joints[j];
    if (!joint.seen()) continue;
    if (changed && expected[j].placed) offset += kept * (expected[j].position - joint.position);
    if (offset.isZero(kNoOffset)) continue;
    joint.position += offset;
    const Eigen::Matrix3d covariance = joint.covariance.matrix() + offset * offset.transpose();
    joint.covariance = Covariance(covariance);
    body.variance[j] = mean_variance(covariance);
  }
}

}  // namespace chorus::fusion
