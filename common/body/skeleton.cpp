#include "common/body/skeleton.h"

#include <algorithm>

namespace chorus {
namespace {

template <class To, class From>
Skeleton<To> moved(const Eigen::Isometry3d& to_from_from, const Skeleton<From>& body) {
  const Eigen::Quaterniond turn(to_from_from.linear());
  Skeleton<To> result;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Joint& joint = body.joints[i];
    const bool ray = joint.measurement == Measurement::Ray;
    result.joints[i] = {ray ? turn * joint.position : to_from_from * joint.position,
                        turn * joint.orientation, joint.state, joint.measurement,
                        joint.covariance.turned(to_from_from.linear())};
  }
  return result;
}

}  // namespace

bool has_rays_alone(const std::array<Joint, kJointCount>& joints) {
  return std::ranges::any_of(joints, &Joint::bears) && std::ranges::none_of(joints, &Joint::seen);
}

Skeleton<WorldSpace> to_world(const Eigen::Isometry3d& world_from_sensor,
                              const Skeleton<SensorSpace>& body) {
  return moved<WorldSpace>(world_from_sensor, body);
}

Skeleton<SensorSpace> to_sensor(const Eigen::Isometry3d& sensor_from_world,
                                const Skeleton<WorldSpace>& body) {
  return moved<SensorSpace>(sensor_from_world, body);
}

}  // namespace chorus
