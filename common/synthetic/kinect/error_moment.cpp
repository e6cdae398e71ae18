#include "common/synthetic/kinect/error_moment.h"

#include <utility>

#include "common/body/bones.h"
#include "common/synthetic/kinect/leader.h"

namespace chorus::synthetic::kinect {
namespace {

/// The exact body with the labels that the SDK gives to its joints.
Skeleton<SensorSpace> labelled(const Skeleton<SensorSpace>& exact, const FlipState& flip) {
  Skeleton<SensorSpace> body = exact;
  if (flip.blend <= 0.5) return body;
  for (const auto& [left, right] : kMirrorPairs) std::swap(body[left], body[right]);
  return body;
}

/// Moments before bones are given fixed lengths: random error, bias, and the displacement caused by
/// the wrong yaw that the SDK shows.
Moments of_free_joints(const Sight& sight, double time, const Profile& profile,
                       const ErrorKeys& keys) {
  const double facing = sight.stand.view.facing;
  const Skeleton<SensorSpace> right = labelled(sight.exact, sight.flip);
  const Skeleton<SensorSpace> turned = as_shown(sight.exact, facing, sight.flip, profile.yaw);
  Moments moments;
  moments.fill(Eigen::Matrix3d::Zero());
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    if (!sight.shown[id].seen()) continue;
    const Eigen::Vector3d moved = turned[id].position - right[id].position;
    moments[i] = error_moment(id, sight.shown, sight.stand, time, profile, keys) +
                 bias_moment(id, right[id].position, facing, profile.bias) +
                 moved * moved.transpose();
  }
  return moments;
}

/// Moment of the difference between the errors of a bone's two ends, which turns the bone.  It is
/// small if one end follows the other (leader.h).
Eigen::Matrix3d turning(const Moments& free, JointId parent, JointId child,
                        const ColouredError& coloured) {
  const Eigen::Matrix3d apart = free[index_of(parent)] + free[index_of(child)];
  const bool follows = leader(child) == parent || leader(parent) == child;
  return follows ? Eigen::Matrix3d((1.0 - coloured.follow_share) * apart) : apart;
}

Moments of_fitted_body(const Moments& free, const Sight& sight, const Profile& profile) {
  const BodyFit& fit = profile.fit;
  Eigen::Matrix3d trunk = Eigen::Matrix3d::Zero();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const JointId id : kCoreJoints) {
    trunk += free[index_of(id)] / static_cast<double>(kCoreJoints.size());
    middle += sight.exact[id].position / static_cast<double>(kCoreJoints.size());
  }
  Moments moments;
  moments.fill(Eigen::Matrix3d::Zero());
  const double core = profile.coloured.core_correlation;
  const double shared = core + (1.0 - core) / static_cast<double>(kCoreJoints.size());
  for (const JointId id : kCoreJoints) moments[index_of(id)] = shared * trunk;
  for (const auto& [parent, child] : kBones) {
    // Joints of the trunk got theirs above; they all have the trunk's mean error.
    if (mirror(child) == child) continue;
    const Eigen::Vector3d bone = sight.exact[child].position - sight.exact[parent].position;
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - bone.normalized() * bone.normalized().transpose();
    const Eigen::Matrix3d come = across * turning(free, parent, child, profile.coloured) * across +
                                 fit.proportion * fit.proportion * bone * bone.transpose();
    moments[index_of(child)] = moments[index_of(parent)] + come;
  }
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Eigen::Vector3d reach = sight.exact.joints[i].position - middle;
    const double scale = fit.scale * fit.scale + fit.scale_white * fit.scale_white;
    moments[i] += scale * reach * reach.transpose();
  }
  return moments;
}

}  // namespace

Moments moments_of(const Sight& sight, double time, const Profile& profile, const ErrorKeys& keys) {
  const Moments free = of_free_joints(sight, time, profile, keys);
  return profile.fit.bones > 0 ? of_fitted_body(free, sight, profile) : free;
}

void confide(Skeleton<SensorSpace>& body, const Moments& moments) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (body.joints[i].seen()) body.joints[i].covariance = Covariance(moments[i]);
  }
}

}  // namespace chorus::synthetic::kinect
