#include "fusion-server/fusion/prediction.h"

#include "common/body/bones.h"
#include "fusion-server/fusion/bone_tree.h"
#include "fusion-server/fusion/joint_filters.h"
#include "fusion-server/fusion/motion_filter.h"

namespace chorus::fusion {
namespace {

constexpr double kRigidBone = 0.003;      // [m] how constant a bone is from one pose to the next
constexpr double kPredictedFloor = 1e-8;  // [m^2]

HeldBones bones_of(const Skeleton<WorldSpace>& body) {
  HeldBones bones;
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    const Joint& parent = body[kBones[b].parent];
    const Joint& child = body[kBones[b].child];
    if (!parent.seen() || !child.seen()) continue;
    bones[b] = {(child.position - parent.position).norm(), kRigidBone};
  }
  return bones;
}

PointMotion moved(const FusedBody& body, std::size_t joint, double passed) {
  const Joint& now = body.skeleton.joints[joint];
  PointMotion point{now.position, 0.0, {Eigen::Vector3d::Zero(), kFirstSpeed * kFirstSpeed}};
  if (body.motion) point.motion = (*body.motion)[joint];
  return later(point, passed);
}

PlacedJoint placed(const FusedBody& body, std::size_t joint, const PointMotion& then) {
  const Joint& now = body.skeleton.joints[joint];
  const double known = now.covariance.known() ? 0.0 : body.variance[joint];
  const double variance = kPredictedFloor + known + then.variance;
  return {then.position, now.covariance.matrix() + variance * Eigen::Matrix3d::Identity(), true};
}

}  // namespace

FusedBody predicted(const FusedBody& body, Duration ahead) {
  if (ahead <= Duration{0}) return body;
  FusedBody later = body;
  PlacedBody moved_on;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!body.skeleton.joints[j].seen()) continue;
    const PointMotion then = moved(body, j, seconds(ahead));
    moved_on[j] = placed(body, j, then);
    if (later.motion && (*later.motion)[j].variance > 0) (*later.motion)[j] = then.motion;
  }
  const PlacedBody whole = hold_bones(moved_on, bones_of(body.skeleton));
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!whole[j].placed) continue;
    FusedJoint joint{body.skeleton.joints[j], 0.0, body.contributors[j]};
    joint.shares = body.shares[j];
    joint.age = body.age[j] + seconds(ahead);
    joint.joint.position = whole[j].position;
    state_covariance(joint, moved_on[j].covariance);
    put(later, static_cast<JointId>(j), joint);
  }
  return later;
}

}  // namespace chorus::fusion
