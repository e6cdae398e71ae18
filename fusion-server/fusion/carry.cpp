#include "fusion-server/fusion/carry.h"

#include <algorithm>

#include "common/body/bones.h"
#include "fusion-server/fusion/joint_filters.h"

namespace chorus::fusion {
namespace {

constexpr double kDrift = 0.4;  // [m/s] per axis, by which somebody goes another way than expected

/// Of the core joints, of all if none of these is seen.
Eigen::Vector3d middle_of(const Skeleton<WorldSpace>& body) {
  Eigen::Vector3d core = Eigen::Vector3d::Zero();
  Eigen::Vector3d all = Eigen::Vector3d::Zero();
  double cores = 0.0;
  double count = 0.0;
  for (const JointId id : kCoreJoints) {
    if (!body[id].seen()) continue;
    core += body[id].position;
    cores += 1.0;
  }
  for (const Joint& joint : body.joints) {
    if (!joint.seen()) continue;
    all += joint.position;
    count += 1.0;
  }
  return cores > 0 ? Eigen::Vector3d(core / cores) : Eigen::Vector3d(all / std::max(1.0, count));
}

}  // namespace

FusedBody carry(const FusedBody& last, Duration unseen, const Eigen::Vector3d& middle) {
  FusedBody body = last;
  Eigen::Vector3d way = middle - middle_of(last.skeleton);
  way.y() = 0.0;
  const double drift = kDrift * seconds(unseen);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Joint joint = last.skeleton.joints[i];
    if (!joint.seen()) continue;
    joint.position += way;
    joint.state = JointState::Inferred;
    FusedJoint carried{joint, 0.0, 0};
    state_covariance(carried,
                     joint.covariance.matrix() + drift * drift * Eigen::Matrix3d::Identity());
    put(body, static_cast<JointId>(i), carried);
  }
  body.slot.reset();
  return body;
}

}  // namespace chorus::fusion
