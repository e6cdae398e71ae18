#include "common/synthetic/body_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/body/bones.h"

namespace chorus::synthetic {
namespace {

constexpr double kHeadRadius = 0.11;   // [m]
constexpr double kOtherRadius = 0.04;  // [m]; for bones that the table does not name.

struct Radius {
  JointId child;  ///< The joint at which the bone ends.
  double radius;  ///< [m]
};

// Plausible figures for a clothed adult; there is no measured source.
constexpr std::array kRadii{
    Radius{JointId::SpineMid, 0.15},     Radius{JointId::SpineShoulder, 0.15},
    Radius{JointId::Neck, 0.06},         Radius{JointId::Head, 0.06},
    Radius{JointId::ShoulderLeft, 0.08}, Radius{JointId::ShoulderRight, 0.08},
    Radius{JointId::ElbowLeft, 0.055},   Radius{JointId::ElbowRight, 0.055},
    Radius{JointId::WristLeft, 0.045},   Radius{JointId::WristRight, 0.045},
    Radius{JointId::HipLeft, 0.12},      Radius{JointId::HipRight, 0.12},
    Radius{JointId::KneeLeft, 0.085},    Radius{JointId::KneeRight, 0.085},
    Radius{JointId::AnkleLeft, 0.06},    Radius{JointId::AnkleRight, 0.06},
    Radius{JointId::ThumbLeft, 0.015},   Radius{JointId::ThumbRight, 0.015},
    Radius{JointId::HandTipLeft, 0.025}, Radius{JointId::HandTipRight, 0.025},
};

double radius_of(JointId child) {
  const auto* found = std::find_if(kRadii.begin(), kRadii.end(),
                                   [&](const Radius& each) { return each.child == child; });
  return found == kRadii.end() ? kOtherRadius : found->radius;
}

std::optional<double> hit_ball(const Eigen::Vector3d& centre, double radius,
                               const Eigen::Vector3d& ray) {
  const double closest = ray.dot(centre);
  const double gap = radius * radius - (centre.squaredNorm() - closest * closest);
  if (gap < 0) return std::nullopt;
  const double distance = closest - std::sqrt(gap);
  return distance > 0 ? std::optional(distance) : std::nullopt;
}

}  // namespace

std::vector<Capsule> capsules_of(const Skeleton<SensorSpace>& body) {
  std::vector<Capsule> capsules;
  for (const Bone& bone : kBones) {
    const Joint& parent = body[bone.parent];
    const Joint& child = body[bone.child];
    if (!parent.seen() || !child.seen()) continue;
    capsules.push_back({parent.position, child.position, radius_of(bone.child)});
  }
  const Joint& head = body[JointId::Head];
  if (head.seen()) capsules.push_back({head.position, head.position, kHeadRadius});
  return capsules;
}

std::optional<double> hit(const Capsule& capsule, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d axis = capsule.to - capsule.from;
  const double length = axis.norm();
  if (length < 1e-9) return hit_ball(capsule.from, capsule.radius, ray);
  // Intersects the ray with the infinite cylinder about the axis: |(t ray - from) x axis|^2 =
  // radius^2 |axis|^2.
  const Eigen::Vector3d unit = axis / length;
  const Eigen::Vector3d ray_across = ray - ray.dot(unit) * unit;
  const Eigen::Vector3d from_across = capsule.from - capsule.from.dot(unit) * unit;
  const double a = ray_across.squaredNorm();
  const double b = ray_across.dot(from_across);
  const double root = b * b - a * (from_across.squaredNorm() - capsule.radius * capsule.radius);
  if (a > 1e-12 && root >= 0) {
    const double distance = (b - std::sqrt(root)) / a;
    const double along = (distance * ray - capsule.from).dot(unit);
    if (distance > 0 && along >= 0 && along <= length) return distance;
  }
  const auto near = hit_ball(capsule.from, capsule.radius, ray);
  const auto far = hit_ball(capsule.to, capsule.radius, ray);
  if (near && far) return std::min(*near, *far);
  return near ? near : far;
}

}  // namespace chorus::synthetic
