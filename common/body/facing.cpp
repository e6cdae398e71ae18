#include "common/body/facing.h"

#include <cmath>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus {
namespace {

/// The direction in which the body faces, as a unit vector in the x-z plane: the line from `right`
/// to `left` crossed with +y.  None if a joint is not seen, or the line is vertical.
std::optional<Eigen::Vector3d> forward_of(const Joint& left, const Joint& right) {
  if (!left.seen() || !right.seen()) return std::nullopt;
  Eigen::Vector3d to_left = left.position - right.position;
  to_left.y() = 0;
  if (to_left.norm() < 1e-6) return std::nullopt;
  return to_left.normalized().cross(Eigen::Vector3d::UnitY()).eval();
}

std::optional<double> bearing_of(const Joint& joint) {
  if (!joint.seen()) return std::nullopt;
  return std::atan2(joint.position.x(), joint.position.z());
}

}  // namespace

std::optional<double> facing_angle(const Skeleton<SensorSpace>& body) {
  auto forward = forward_of(body[JointId::ShoulderLeft], body[JointId::ShoulderRight]);
  if (!forward) forward = forward_of(body[JointId::HipLeft], body[JointId::HipRight]);
  const Joint& neck = body[JointId::Neck].seen() ? body[JointId::Neck] : body[JointId::SpineBase];
  if (!forward || !neck.seen()) return std::nullopt;
  const Eigen::Vector3d to_sensor(-neck.position.x(), 0, -neck.position.z());
  if (to_sensor.norm() < 1e-6) return std::nullopt;
  const double heading = std::atan2(forward->x(), forward->z());
  return wrap_angle(heading - std::atan2(to_sensor.x(), to_sensor.z()));
}

std::optional<double> bearing_angle(const Skeleton<SensorSpace>& body) {
  return bearing_of(body[JointId::Neck]);
}

std::optional<double> axis_bearing_angle(const Skeleton<SensorSpace>& body) {
  std::optional<double> farthest;
  for (const JointId id : kCoreJoints) {
    const auto bearing = bearing_of(body[id]);
    if (bearing && (!farthest || std::abs(*bearing) > std::abs(*farthest))) farthest = bearing;
  }
  return farthest;
}

std::optional<double> neck_distance(const Skeleton<SensorSpace>& body) {
  const Joint& neck = body[JointId::Neck];
  if (!neck.seen()) return std::nullopt;
  return neck.position.norm();
}

}  // namespace chorus
