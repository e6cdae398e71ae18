#include "common/synthetic/kinect/visibility.h"

#include <algorithm>
#include <cmath>

#include "common/body/bones.h"

namespace chorus::synthetic::kinect {
namespace {

constexpr double kFan = 0.03;   // offset of the outer rays about a joint [m]
constexpr double kSkin = 0.02;  // a hit this close before the joint is the joint's own surface [m]

double distance_to_axis(const Capsule& capsule, const Eigen::Vector3d& point) {
  const Eigen::Vector3d axis = capsule.to - capsule.from;
  const double length = axis.squaredNorm();
  const double s =
      length < 1e-12 ? 0.0 : std::clamp((point - capsule.from).dot(axis) / length, 0.0, 1.0);
  return (point - (capsule.from + s * axis)).norm();
}

/// Whose joint it is; real logs: the trunk's own limbs hardly ever make it "inferred" (0-3 %).
struct Self {
  std::size_t index;
  bool is_core;
};

/// Cheap and safe: the ball around the capsule lies beside the ray.
bool is_beside(const Capsule& capsule, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d middle = 0.5 * (capsule.from + capsule.to);
  const double reach = 0.5 * (capsule.to - capsule.from).norm() + capsule.radius;
  return (middle - middle.dot(ray) * ray).squaredNorm() > reach * reach;
}

bool is_blocked(const Eigen::Vector3d& end, const Eigen::Vector3d& joint, const Self& self,
                const Obstacles& obstacles) {
  const double range = end.norm();
  const Eigen::Vector3d ray = end / range;
  for (std::size_t body = 0; body < obstacles.bodies.size(); ++body) {
    for (const Capsule& capsule : obstacles.bodies[body]) {
      if (is_beside(capsule, ray)) continue;
      const bool own = body == self.index;
      if (own && (self.is_core || distance_to_axis(capsule, joint) < capsule.radius + kSkin))
        continue;
      const auto distance = hit(capsule, ray);
      if (distance && *distance < range - kSkin) return true;
    }
  }
  return std::ranges::any_of(obstacles.boxes, [&](const Box& box) { return blocks(box, end); });
}

/// The joint itself, then points around it across the line of sight.
Eigen::Vector3d ray_end(const Eigen::Vector3d& joint, int index) {
  if (index == 0) return joint;
  const Eigen::Vector3d ray = joint.normalized();
  const Eigen::Vector3d right = ray.cross(Eigen::Vector3d::UnitY()).stableNormalized();
  const Eigen::Vector3d up = right.cross(ray);
  constexpr std::array<std::array<double, 2>, 4> kCross{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  const auto& [x, y] = kCross[static_cast<std::size_t>(index - 1) % kCross.size()];
  return joint + kFan * (x * right + y * up);
}

}  // namespace

bool blocks(const Box& box, const Eigen::Vector3d& end) {
  const Eigen::Isometry3d box_from_sensor = box.sensor_from_box.inverse();
  const Eigen::Vector3d eye = box_from_sensor.translation();
  const Eigen::Vector3d along = box_from_sensor * end - eye;
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double half = box.half[axis];
    if (std::abs(along[axis]) < 1e-12) {
      if (std::abs(eye[axis]) > half) return false;
      continue;
    }
    const double a = (-half - eye[axis]) / along[axis];
    const double b = (half - eye[axis]) / along[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave;
}

std::array<double, kJointCount> visible_share(const Skeleton<SensorSpace>& body, std::size_t self,
                                              const Obstacles& obstacles,
                                              const Visibility& visibility) {
  std::array<double, kJointCount> share;
  share.fill(1.0);
  const int rays = static_cast<int>(visibility.rays);
  if (rays <= 0) return share;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Eigen::Vector3d& joint = body.joints[i].position;
    if (!body.joints[i].seen() || joint.norm() < 1e-6) continue;
    int arrived = 0;
    for (int ray = 0; ray < rays; ++ray) {
      const Self whose{self, mirror(static_cast<JointId>(i)) == static_cast<JointId>(i)};
      if (!is_blocked(ray_end(joint, ray), joint, whose, obstacles)) ++arrived;
    }
    share[i] = static_cast<double>(arrived) / rays;
  }
  return share;
}

}  // namespace chorus::synthetic::kinect
