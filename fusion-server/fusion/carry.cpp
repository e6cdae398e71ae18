#include "fusion-server/fusion/carry.h"

#include "common/body/located.h"
#include "fusion-server/fusion/joint_filters.h"

namespace chorus::fusion {
namespace {

constexpr double kDrift = 0.4;  // [m/s] per axis: how fast somebody departs from the expected path

}  // namespace

FusedBody carry(const FusedBody& last, Duration unseen, const Eigen::Vector3d& middle) {
  FusedBody body = last;
  const auto last_middle = middle_of(points_of(last.skeleton));
  Eigen::Vector3d way = middle - last_middle.value_or(middle);
  way.y() = 0.0;
  const double drift = kDrift * seconds(unseen);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Joint joint = last.skeleton.joints[i];
    if (!joint.seen()) continue;
    joint.position += way;
    joint.state = JointState::Inferred;
    FusedJoint carried{joint, 0.0, 0, {}, last.age[i] + seconds(unseen)};
    state_covariance(carried,
                     joint.covariance.matrix() + drift * drift * Eigen::Matrix3d::Identity());
    put(body, static_cast<JointId>(i), carried);
  }
  body.slot.reset();
  body.motion.reset();
  return body;
}

}  // namespace chorus::fusion
