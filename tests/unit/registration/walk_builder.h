// A walk made by hand: a person whose joints are known in the world, seen by sensors whose poses
// are known.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/sensor/sensor_frame.h"
#include "fusion-server/registration/registration.h"

namespace chorus::registration {

constexpr Timestamp kWalkStart = from_unix_ns(1'790'000'000'000'000'000);

inline SensorId sensor(int number) { return SensorId::parse("s" + std::to_string(number)).value(); }

/// World pose of a sensor at (x, z), 1.8 m high, looking along `yaw` and 15 deg downwards.
inline Eigen::Isometry3d place(double x, double z, double yaw) {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  world_from_sensor.linear() =
      (about_y(yaw) * Eigen::AngleAxisd(deg(15), Eigen::Vector3d::UnitX())).toRotationMatrix();
  world_from_sensor.translation() = Eigen::Vector3d(x, 1.8, z);
  return world_from_sensor;
}

/// Pose of a sensor on a circle of `radius` about the origin, looking at its centre.
inline Eigen::Isometry3d ring_place(double angle, double radius = 3.0) {
  return place(radius * std::sin(angle), radius * std::cos(angle), angle + std::numbers::pi);
}

/// Position of the person on the floor after t seconds.
using Path = std::function<Eigen::Vector2d(double)>;

/// A path that wanders over about +-1 m with changing speed, below 1 m/s.
inline Eigen::Vector2d wander(double t) {
  return {0.8 * std::sin(0.61 * t) + 0.3 * std::sin(1.33 * t + 1.0),
          0.7 * std::cos(0.47 * t + 0.5) + 0.3 * std::sin(1.07 * t)};
}

/// A body of 25 joints above a floor point; heights and widths are roughly human.
inline Skeleton<WorldSpace> person_at(const Eigen::Vector2d& floor, double yaw, double t) {
  struct Part {
    JointId id;
    double aside, up;
  };
  using enum JointId;
  constexpr std::array<Part, kJointCount> kParts{{
      {SpineBase, 0, 0.95},     {SpineMid, 0, 1.2},        {Neck, 0, 1.5},
      {Head, 0, 1.65},          {ShoulderLeft, -0.2, 1.4}, {ElbowLeft, -0.3, 1.15},
      {WristLeft, -0.3, 0.9},   {HandLeft, -0.3, 0.85},    {ShoulderRight, 0.2, 1.4},
      {ElbowRight, 0.3, 1.15},  {WristRight, 0.3, 0.9},    {HandRight, 0.3, 0.85},
      {HipLeft, -0.1, 0.93},    {KneeLeft, -0.12, 0.5},    {AnkleLeft, -0.12, 0.1},
      {FootLeft, -0.12, 0.05},  {HipRight, 0.1, 0.93},     {KneeRight, 0.12, 0.5},
      {AnkleRight, 0.12, 0.1},  {FootRight, 0.12, 0.05},   {SpineShoulder, 0, 1.42},
      {HandTipLeft, -0.3, 0.8}, {ThumbLeft, -0.27, 0.85},  {HandTipRight, 0.3, 0.8},
      {ThumbRight, 0.27, 0.85},
  }};
  Skeleton<WorldSpace> body;
  const double bob = 0.02 * std::sin(8.0 * t);
  for (const auto& [id, aside, up] : kParts) {
    const Eigen::Vector3d offset = about_y(yaw) * Eigen::Vector3d(aside, 0, 0);
    body[id].position = Eigen::Vector3d(floor.x(), up + bob, floor.y()) + offset;
    body[id].state = JointState::Tracked;
  }
  return body;
}

struct WalkSpec {
  Path path = wander;
  double length = 20.0;  ///< [s]
  double noise = 0.010;  ///< White noise per axis [m].
  double range = 100.0;  ///< People farther away are not seen [m].
  std::optional<FloorPlane> floor_in_world = FloorPlane{};
  Duration clock_offset{};  ///< The host clock's error: added to the capture stamps.
  double outliers = 0.0;    ///< Fraction of frames whose body is elsewhere.
  unsigned seed = 1;
};

inline FloorPlane plane_in_sensor(const FloorPlane& in_world,
                                  const Eigen::Isometry3d& world_from_sensor) {
  return {world_from_sensor.linear().transpose() * in_world.normal,
          in_world.offset + in_world.normal.dot(world_from_sensor.translation())};
}

/// Frames of a sensor at `world_from_sensor` during the walk, at 30 Hz; each sensor has its own
/// phase.
inline WalkTrack watch(int number, const Eigen::Isometry3d& world_from_sensor,
                       const WalkSpec& spec) {
  std::mt19937 random(spec.seed * 1000 + static_cast<unsigned>(number));
  std::normal_distribution<double> normal;
  const auto noise = [&] { return spec.noise * normal(random); };  // also none at all
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  WalkTrack track{sensor(number), {}};
  const Eigen::Isometry3d sensor_from_world = world_from_sensor.inverse();
  for (double t = 0.004 * number; t < spec.length; t += 1.0 / 30.0) {
    const Eigen::Vector2d floor = spec.path(t);
    Skeleton<SensorSpace> body = to_sensor(sensor_from_world, person_at(floor, 0.5 * t, t));
    if (body[JointId::Neck].position.norm() > spec.range) continue;
    const Eigen::Vector3d jump = chance(random) < spec.outliers
                                     ? Eigen::Vector3d(chance(random), 0, 2.0 * chance(random))
                                     : Eigen::Vector3d::Zero();
    for (Joint& joint : body.joints) {
      joint.position += jump + Eigen::Vector3d(noise(), noise(), noise());
    }
    SensorFrame frame;
    frame.sensor = track.sensor;
    frame.captured = kWalkStart + from_seconds(t) + spec.clock_offset;
    frame.bodies = {{BodyId{1}, frame.captured, body}};
    if (spec.floor_in_world) frame.floor = plane_in_sensor(*spec.floor_in_world, world_from_sensor);
    track.frames.push_back(std::move(frame));
  }
  return track;
}

/// Moves every joint along its line of sight by a depth error of its own.
inline WalkTrack with_depth_error(WalkTrack track, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (SensorFrame& frame : track.frames) {
    for (Joint& joint : frame.bodies[0].skeleton.joints) {
      joint.position *= 1.0 + sigma * normal(random) / joint.position.norm();
    }
  }
  return track;
}

/// Moves every joint towards the sensor.
inline WalkTrack nearer_by(double depth_bias, WalkTrack track) {
  for (SensorFrame& frame : track.frames) {
    for (Joint& joint : frame.bodies[0].skeleton.joints)
      joint.position -= depth_bias * joint.position.normalized();
  }
  return track;
}

struct PlaceError {
  double position = 0.0;  ///< [m]
  double angle = 0.0;     ///< [rad]
};

inline PlaceError difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return {(a.translation() - b.translation()).norm(),
          angular_distance(Eigen::Quaterniond(a.linear()), Eigen::Quaterniond(b.linear()))};
}

}  // namespace chorus::registration
