#include "fusion-server/registration/floor_constraint.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus::registration {
namespace {

constexpr double kMinUp = 0.5;         // cos(60 deg): a floor tilted more against people is a wall
constexpr double kMinHeight = 0.10;    // [m] least height of the sensor above its floor
constexpr double kFeetBelow = 0.25;    // [m] feet lower than this contradict the plane
constexpr double kFeetAbove = 0.60;    // [m] feet that stay higher than this contradict it, too
constexpr double kLowestShare = 0.10;  // percentile of the feet's heights that counts as the floor
constexpr double kViewIsVertical =
    0.05;  // if the horizontal part of the viewing direction is smaller, the yaw is kept
// Floors whose tilt or height deviates more than this from the median are left out.
constexpr double kFarTilt = deg(1.5);
constexpr double kFarHeight = 0.05;        // [m]
constexpr double kFootJointHeight = 0.05;  // [m] height of the lowest foot joint above the sole

constexpr std::array kFeet{JointId::AnkleLeft, JointId::AnkleRight, JointId::FootLeft,
                           JointId::FootRight};

double quantile(std::vector<double>& values, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

std::optional<FloorPlane> median_floor(const WalkTrack& walk) {
  std::array<std::vector<double>, 4> parts;
  for (const SensorFrame& frame : walk.frames) {
    if (!frame.floor || !frame.floor->normal.allFinite()) continue;
    for (int axis = 0; axis < 3; ++axis) {
      parts[static_cast<std::size_t>(axis)].push_back(frame.floor->normal[axis]);
    }
    parts[3].push_back(frame.floor->offset);
  }
  if (parts[3].empty()) return std::nullopt;
  const auto plane = make_plane(quantile(parts[0], 0.5), quantile(parts[1], 0.5),
                                quantile(parts[2], 0.5), quantile(parts[3], 0.5));
  if (!plane) return std::nullopt;
  return *plane;
}

/// Height above the plane below which a tenth of all foot joints lie.
std::optional<double> lowest_feet(const WalkTrack& walk, const FloorPlane& floor) {
  std::vector<double> heights;
  for (const SensorFrame& frame : walk.frames) {
    for (const BodyFrame& body : frame.bodies) {
      for (const JointId foot : kFeet) {
        const Joint& joint = body.skeleton[foot];
        if (joint.seen()) heights.push_back(floor.distance(joint.position));
      }
    }
  }
  if (heights.empty()) return std::nullopt;
  return quantile(heights, kLowestShare);
}

/// Where the person walked, in sensor space.
std::optional<Eigen::Vector3d> middle_of_hips(const WalkTrack& walk) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const SensorFrame& frame : walk.frames) {
    for (const BodyFrame& body : frame.bodies) {
      const Joint& base = body.skeleton[JointId::SpineBase];
      if (!base.seen()) continue;
      sum += base.position;
      count += 1.0;
    }
  }
  if (count == 0.0) return std::nullopt;
  return Eigen::Vector3d(sum / count);
}

std::string objection_to(const FloorPlane& floor, const WalkTrack& walk) {
  const auto up = upright(walk);
  if (up && floor.normal.dot(*up) < kMinUp) return "its floor plane does not point up";
  if (floor.offset < kMinHeight) return "its floor plane is not below it";
  const auto feet = lowest_feet(walk, floor);
  if (feet && *feet < -kFeetBelow) {
    return fmt::format("its floor plane lies {:.2f} m above the person's feet", -*feet);
  }
  if (feet && *feet > kFeetAbove) {
    return fmt::format("its floor plane lies {:.2f} m below the person's feet", *feet);
  }
  return {};
}

}  // namespace

WalkFloor floor_of(const WalkTrack& walk) {
  const std::optional<FloorPlane> floor = median_floor(walk);
  if (!floor) return {std::nullopt, "it reports no floor plane"};
  std::string objection = objection_to(*floor, walk);
  if (!objection.empty()) return {std::nullopt, std::move(objection)};
  return {floor, {}};
}

std::optional<Eigen::Vector3d> upright(const WalkTrack& walk) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const SensorFrame& frame : walk.frames) {
    for (const BodyFrame& body : frame.bodies) {
      const Joint& neck = body.skeleton[JointId::Neck];
      const Joint& base = body.skeleton[JointId::SpineBase];
      if (!neck.seen() || !base.seen()) continue;
      const Eigen::Vector3d spine = neck.position - base.position;
      if (spine.norm() > 0) up += spine.normalized();
    }
  }
  const auto direction = make_plane(up.x(), up.y(), up.z(), 0.0);
  if (!direction) return std::nullopt;
  return direction->normal;
}

std::optional<FloorPlane> floor_from_body(const WalkTrack& walk) {
  const auto up = upright(walk);
  if (!up) return std::nullopt;
  FloorPlane floor{*up, 0.0};
  const auto feet = lowest_feet(walk, floor);
  floor.offset = feet ? kFootJointHeight - *feet : 0.0;
  return floor;
}

std::optional<FloorPlane> floor_from_bodies(const std::vector<PlacedWalk>& walks) {
  std::vector<PlacedFloor> floors;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const PlacedWalk& each : walks) {
    const auto own = floor_from_body(*each.walk);
    const auto middle = middle_of_hips(*each.walk);
    if (!own || !middle) continue;
    const Eigen::Vector3d normal = each.common_from_sensor.linear() * own->normal;
    const double offset = own->offset - normal.dot(each.common_from_sensor.translation());
    floors.push_back({{normal, offset}, each.common_from_sensor * *middle});
    up += normal;
  }
  if (floors.empty() || !(up.norm() > 0)) return std::nullopt;
  const Eigen::Vector3d normal = up.normalized();
  std::vector<double> offsets;
  for (const PlacedFloor& each : floors)
    offsets.push_back(each.floor.distance(each.eye) - normal.dot(each.eye));
  return FloorPlane{normal, quantile(offsets, 0.5)};
}

FloorPlane common_floor(const std::vector<PlacedFloor>& floors) {
  std::array<std::vector<double>, 3> parts;
  for (const PlacedFloor& each : floors) {
    for (int axis = 0; axis < 3; ++axis) {
      parts[static_cast<std::size_t>(axis)].push_back(each.floor.normal[axis]);
    }
  }
  const Eigen::Vector3d middle(quantile(parts[0], 0.5), quantile(parts[1], 0.5),
                               quantile(parts[2], 0.5));
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const PlacedFloor& each : floors) {
    if (std::atan2(each.floor.normal.cross(middle).norm(), each.floor.normal.dot(middle)) <
        kFarTilt) {
      normal += each.floor.normal;
    }
  }
  normal = (normal.norm() > 0 ? normal : middle).normalized();
  // Each floor's height is taken below its own sensor, where an error of its tilt is harmless.
  std::vector<double> offsets;
  for (const PlacedFloor& each : floors) {
    offsets.push_back(each.floor.distance(each.eye) - normal.dot(each.eye));
  }
  const double median = quantile(offsets, 0.5);
  double sum = 0.0;
  int count = 0;
  for (const double offset : offsets) {
    if (std::abs(offset - median) > kFarHeight) continue;
    sum += offset;
    ++count;
  }
  return {normal, sum / count};
}

Eigen::Isometry3d world_from_master(const FloorPlane& floor_in_master) {
  const Eigen::Isometry3d levelled_from_master = level(floor_in_master);
  const Eigen::Vector3d view = levelled_from_master.linear() * Eigen::Vector3d::UnitZ();
  if (std::hypot(view.x(), view.z()) < kViewIsVertical) return levelled_from_master;
  return Eigen::Isometry3d(about_y(-std::atan2(view.x(), view.z()))) * levelled_from_master;
}

}  // namespace chorus::registration
