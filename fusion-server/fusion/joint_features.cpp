#include "fusion-server/fusion/joint_features.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/rotation.h"

namespace chorus::fusion {
namespace {

constexpr double kUnknownFeature = std::numeric_limits<double>::quiet_NaN();

double yaw_towards(const Eigen::Vector3d& direction) {
  return std::atan2(direction.x(), direction.z());
}

/// The joint's bearing: that of the neck, which the view states, plus the horizontal angle from the
/// neck to the joint as seen from the sensor.
double bearing_of(const SensorView& view, const Eigen::Vector3d& joint) {
  const Joint& neck = view.skeleton[JointId::Neck];
  if (!neck.seen()) return kUnknownFeature;
  const double beside = yaw_towards(joint - view.eye) - yaw_towards(neck.position - view.eye);
  return wrap_angle(view.bearing + beside);
}

double untracked_share(const SensorView& view) {
  const auto tracked = std::ranges::count(view.skeleton.joints, JointState::Tracked, &Joint::state);
  return 1.0 - static_cast<double>(tracked) / static_cast<double>(kJointCount);
}

}  // namespace

Features features_of(const SensorView& view, JointId id) {
  const Joint& joint = view.skeleton[id];
  const Eigen::Vector3d ray = joint.position - view.eye;
  const double distance = ray.norm();
  const double rise = distance > 0 ? std::clamp(ray.y() / distance, -1.0, 1.0) : kUnknownFeature;
  return {joint.state == JointState::Inferred ? 1.0 : 0.0,
          std::abs(view.facing),
          std::sin(view.facing),
          distance,
          std::abs(bearing_of(view, joint.position)),
          std::asin(rise),
          untracked_share(view)};
}

}  // namespace chorus::fusion
