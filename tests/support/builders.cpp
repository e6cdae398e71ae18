#include "tests/support/builders.h"

#include <array>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::testing {
namespace {

struct Place {
  JointId joint;
  double x, y, z;
};

/// Centre and left joints of a 1.75 m person, facing +z; the right side is the mirror image.
constexpr std::array kStanding{
    Place{JointId::SpineBase, 0, 0.95, 0},       Place{JointId::SpineMid, 0, 1.20, 0},
    Place{JointId::SpineShoulder, 0, 1.43, 0},   Place{JointId::Neck, 0, 1.50, 0},
    Place{JointId::Head, 0, 1.65, 0.02},         Place{JointId::ShoulderLeft, 0.18, 1.40, 0},
    Place{JointId::ElbowLeft, 0.22, 1.12, 0},    Place{JointId::WristLeft, 0.24, 0.87, 0.03},
    Place{JointId::HandLeft, 0.24, 0.80, 0.04},  Place{JointId::HandTipLeft, 0.24, 0.72, 0.05},
    Place{JointId::ThumbLeft, 0.22, 0.80, 0.08}, Place{JointId::HipLeft, 0.08, 0.91, 0},
    Place{JointId::KneeLeft, 0.10, 0.50, 0.02},  Place{JointId::AnkleLeft, 0.10, 0.09, 0},
    Place{JointId::FootLeft, 0.11, 0.03, 0.13},
};

/// The left arm of such a person stretched out at shoulder height; bone lengths differ by at most
/// about a millimetre.
constexpr std::array kStretchedArm{
    Place{JointId::ElbowLeft, 0.46, 1.40, 0},    Place{JointId::WristLeft, 0.71, 1.40, 0},
    Place{JointId::HandLeft, 0.78, 1.40, 0},     Place{JointId::HandTipLeft, 0.86, 1.40, 0},
    Place{JointId::ThumbLeft, 0.74, 1.40, 0.08},
};

constexpr std::array kLeaves{JointId::Head,         JointId::HandTipLeft, JointId::ThumbLeft,
                             JointId::HandTipRight, JointId::ThumbRight,  JointId::FootLeft,
                             JointId::FootRight};

void put(Skeleton<WorldSpace>& body, const Place& at) {
  body[at.joint].position = {at.x, at.y, at.z};
  if (mirror(at.joint) != at.joint) body[mirror(at.joint)].position = {-at.x, at.y, at.z};
}

Skeleton<WorldSpace> moved_to(Skeleton<WorldSpace> body, const Eigen::Vector3d& place,
                              double heading) {
  const Eigen::Quaterniond turn = about_y(heading);
  for (Joint& joint : body.joints) {
    joint.position = place + turn * joint.position;
    joint.orientation = turn;
    joint.state = JointState::Tracked;
  }
  for (const JointId leaf : kLeaves) body[leaf].orientation.coeffs().setZero();
  return body;
}

}  // namespace

Skeleton<WorldSpace> standing_person(const Eigen::Vector3d& place, double heading) {
  Skeleton<WorldSpace> body;
  for (const Place& at : kStanding) put(body, at);
  return moved_to(std::move(body), place, heading);
}

Skeleton<WorldSpace> t_pose_person(const Eigen::Vector3d& place, double heading) {
  Skeleton<WorldSpace> body;
  for (const Place& at : kStanding) put(body, at);
  for (const Place& at : kStretchedArm) put(body, at);
  return moved_to(std::move(body), place, heading);
}

Eigen::Isometry3d sensor_pose(const Eigen::Vector3d& place, double yaw, double pitch) {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  world_from_sensor.linear() =
      (about_y(yaw) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX())).toRotationMatrix();
  world_from_sensor.translation() = place;
  return world_from_sensor;
}

Eigen::Isometry3d ring_sensor(int index, int count, double radius, double height) {
  const double yaw = 2.0 * std::numbers::pi * index / count;
  const Eigen::Vector3d looks_along = about_y(yaw) * Eigen::Vector3d::UnitZ();
  return sensor_pose(-radius * looks_along + Eigen::Vector3d(0, height, 0), yaw);
}

FloorPlane floor_seen_from(const Eigen::Isometry3d& world_from_sensor) {
  const Eigen::Vector3d up_in_sensor =
      world_from_sensor.linear().transpose() * Eigen::Vector3d::UnitY();
  return {up_in_sensor, world_from_sensor.translation().y()};
}

BodyFrame body_seen_from(const Eigen::Isometry3d& world_from_sensor,
                         const Skeleton<WorldSpace>& person, Timestamp captured,
                         std::uint64_t body_id) {
  return {BodyId{body_id}, captured, to_sensor(world_from_sensor.inverse(), person)};
}

SensorFrame sensor_frame(std::string_view sensor, Timestamp captured,
                         std::vector<BodyFrame> bodies) {
  SensorFrame frame;
  frame.sensor = sensor_id(sensor);
  frame.sequence = static_cast<std::uint64_t>((captured - kStart) / kFrameInterval);
  frame.captured = captured;
  frame.received = captured;
  frame.bodies = std::move(bodies);
  return frame;
}

SensorId sensor_id(std::string_view text) {
  Result<SensorId> id = SensorId::parse(text);
  if (!id) std::abort();
  return *std::move(id);
}

void hide(Joint& joint) { joint = Joint{}; }

}  // namespace chorus::testing
