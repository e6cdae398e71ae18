#include "common/synthetic/kinect/visibility.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/body/bones.h"

namespace chorus::synthetic::kinect {
namespace {

double distance_to_axis(const Capsule& capsule, const Eigen::Vector3d& point) {
  const Eigen::Vector3d axis = capsule.to - capsule.from;
  const double length = axis.squaredNorm();
  const double s =
      length < 1e-12 ? 0.0 : std::clamp((point - capsule.from).dot(axis) / length, 0.0, 1.0);
  return (point - (capsule.from + s * axis)).norm();
}

/// A capsule and its bounding ball.
struct Obstacle {
  const Capsule* capsule;
  Eigen::Vector3d middle;
  double reach;
  bool own;
};

std::vector<Obstacle> all_of(const Obstacles& obstacles, std::size_t self) {
  std::vector<Obstacle> all;
  for (std::size_t body = 0; body < obstacles.bodies.size(); ++body) {
    for (const Capsule& capsule : obstacles.bodies[body]) {
      all.push_back({&capsule, 0.5 * (capsule.from + capsule.to),
                     0.5 * (capsule.to - capsule.from).norm() + capsule.radius, body == self});
    }
  }
  return all;
}

/// One joint and the capsules that may hide it.
struct Target {
  Eigen::Vector3d joint;
  bool is_core;
  double skin;                           ///< [m]
  std::vector<const Capsule*> capsules;  ///< Near any of its rays.
};

/// Keeps the capsules whose balls come within `fan` of the ray to the joint.  Leaves out the limb
/// that contains the joint, and for joints of the trunk all capsules of the same body: in real logs
/// a person's own limbs hardly ever make the trunk "inferred" (0-3 %).
void choose(Target& target, const std::vector<Obstacle>& all, double fan) {
  target.capsules.clear();
  const Eigen::Vector3d ray = target.joint.normalized();
  for (const Obstacle& each : all) {
    if (each.own && target.is_core) continue;
    const double reach = each.reach + fan;
    if ((each.middle - each.middle.dot(ray) * ray).squaredNorm() > reach * reach) continue;
    if (each.own &&
        distance_to_axis(*each.capsule, target.joint) < each.capsule->radius + target.skin) {
      continue;
    }
    target.capsules.push_back(each.capsule);
  }
}

bool is_blocked(const Eigen::Vector3d& end, const Target& target, const std::vector<Box>& boxes) {
  const double range = end.norm();
  const Eigen::Vector3d ray = end / range;
  for (const Capsule* capsule : target.capsules) {
    const auto distance = hit(*capsule, ray);
    if (distance && *distance < range - target.skin) return true;
  }
  return std::ranges::any_of(boxes, [&](const Box& box) { return blocks(box, end); });
}

/// Where a ray ends: ray 0 at the joint itself, the others at points around it, across the line of
/// sight.
Eigen::Vector3d ray_end(const Eigen::Vector3d& joint, int index, double fan) {
  if (index == 0) return joint;
  const Eigen::Vector3d ray = joint.normalized();
  const Eigen::Vector3d right = ray.cross(Eigen::Vector3d::UnitY()).stableNormalized();
  const Eigen::Vector3d up = right.cross(ray);
  constexpr std::array<std::array<double, 2>, 4> kCross{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  const auto& [x, y] = kCross[static_cast<std::size_t>(index - 1) % kCross.size()];
  return joint + fan * (x * right + y * up);
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
  const std::vector<Obstacle> all = all_of(obstacles, self);
  Target target{{}, false, visibility.skin, {}};
  for (std::size_t i = 0; i < kJointCount; ++i) {
    target.joint = body.joints[i].position;
    target.is_core = mirror(static_cast<JointId>(i)) == static_cast<JointId>(i);
    if (!body.joints[i].seen() || target.joint.norm() < 1e-6) continue;
    choose(target, all, visibility.fan);
    if (target.capsules.empty() && obstacles.boxes.empty()) continue;
    int arrived = 0;
    for (int ray = 0; ray < rays; ++ray) {
      const Eigen::Vector3d end = ray_end(target.joint, ray, visibility.fan);
      if (!is_blocked(end, target, obstacles.boxes)) ++arrived;
    }
    share[i] = static_cast<double>(arrived) / rays;
  }
  return share;
}

void notice(std::array<double, kJointCount>& hidden, const std::array<double, kJointCount>& visible,
            double dt, const Visibility& visibility) {
  const double keep = visibility.notice > 0 ? std::exp(-dt / visibility.notice) : 0.0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    hidden[i] = keep * hidden[i] + (1.0 - keep) * (1.0 - visible[i]);
  }
}

}  // namespace chorus::synthetic::kinect
