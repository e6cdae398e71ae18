#include "common/synthetic/occluder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/geometry/rotation.h"

namespace chorus::synthetic {

Occluder stand_thing(const OccluderKind& size, const Eigen::Vector3d& foot, double yaw) {
  Occluder thing;
  thing.half = 0.5 * Eigen::Vector3d(size.width, size.height, size.length);
  thing.world_from_box.linear() = about_y(yaw).toRotationMatrix();
  thing.world_from_box.translation() = foot + thing.half.y() * Eigen::Vector3d::UnitY();
  return thing;
}

Eigen::Isometry3d place_of(const Occluder& occluder, Duration since_epoch) {
  Eigen::Isometry3d place = occluder.world_from_box;
  if (occluder.period > Duration{0}) {
    const double phase =
        2.0 * std::numbers::pi * seconds(since_epoch % occluder.period) / seconds(occluder.period);
    place.translation() += 0.5 * (1.0 - std::cos(phase)) * occluder.travel;
  }
  return place;
}

std::optional<double> hit_box(const Eigen::Vector3d& half, const Eigen::Vector3d& eye,
                              const Eigen::Vector3d& ray) {
  if (!eye.allFinite() || !ray.allFinite()) return std::nullopt;
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (ray[axis] == 0.0) {
      if (std::abs(eye[axis]) > half[axis]) return std::nullopt;
      continue;
    }
    const double a = (-half[axis] - eye[axis]) / ray[axis];
    const double b = (half[axis] - eye[axis]) / ray[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter > 0.0 && enter <= leave ? std::optional(enter) : std::nullopt;
}

}  // namespace chorus::synthetic
