// One tracked body at one instant: 25 joints in one coordinate space.
//
// Units: metres, unit quaternions (Hamilton; an orientation takes joint axes to the axes of Space).
// Spaces: right-handed, +y up.  The space is part of the type, so a skeleton in sensor space cannot
// reach fusion without its sensor's registration.  See docs/terminology.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

#include "common/body/covariance.h"

namespace chorus {

struct SensorSpace;  ///< Origin at the depth camera's focal point, +z into the scene.
struct WorldSpace;   ///< +y up, y = 0 on the common floor; yaw and origin of the master sensor.

/// Joints in Kinect v2 order (Otto et al., Fig. 2); a joint's value is its number in VRPN and
/// DTrack.
// clang-format off
enum class JointId : std::uint8_t {
  SpineBase, SpineMid, Neck, Head,
  ShoulderLeft, ElbowLeft, WristLeft, HandLeft,
  ShoulderRight, ElbowRight, WristRight, HandRight,
  HipLeft, KneeLeft, AnkleLeft, FootLeft,
  HipRight, KneeRight, AnkleRight, FootRight,
  SpineShoulder, HandTipLeft, ThumbLeft, HandTipRight, ThumbRight,
};
// clang-format on
inline constexpr std::size_t kJointCount = 25;

[[nodiscard]] constexpr std::size_t index_of(JointId id) noexcept {
  return static_cast<std::size_t>(id);
}

/// What the sensor reports about a joint.  Inferred: the sensor guesses where the joint is, for
/// example behind an obstacle.
enum class JointState : std::uint8_t { NotTracked, Inferred, Tracked };

/// What a sensor measures of a joint.  A camera without depth knows only its direction.
enum class Measurement : std::uint8_t { Point, Ray };

struct Joint {
  /// For a Point its place [m]; for a Ray the unit vector from the sensor's origin to the joint.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond(0, 0, 0, 0);  ///< All zero: not given.
  JointState state = JointState::NotTracked;
  Measurement measurement = Measurement::Point;
  Covariance covariance = {};  ///< Covariance of `position`, if the sensor knows it.

  /// True for a tracked or inferred point.  Code that cannot use rays asks only this.
  [[nodiscard]] bool seen() const { return measurement == Measurement::Point && given(); }
  /// True for a tracked or inferred ray.
  [[nodiscard]] bool bears() const { return measurement == Measurement::Ray && given(); }
  /// True for a tracked or inferred point or ray.
  [[nodiscard]] bool given() const {
    return state != JointState::NotTracked && position.allFinite();
  }
};

/// True if the body has rays but no point, as from cameras without depth.
[[nodiscard]] bool has_rays_alone(const std::array<Joint, kJointCount>& joints);

template <class Space>
struct Skeleton {
  std::array<Joint, kJointCount> joints;

  [[nodiscard]] const Joint& operator[](JointId id) const { return joints[index_of(id)]; }
  [[nodiscard]] Joint& operator[](JointId id) { return joints[index_of(id)]; }
};

/// The body moved into world space.  Rays are turned, not moved: a ray still begins at its sensor,
/// which the result does not name.
[[nodiscard]] Skeleton<WorldSpace> to_world(const Eigen::Isometry3d& world_from_sensor,
                                            const Skeleton<SensorSpace>& body);

/// The reverse of to_world(), for simulated sensors and tests.
[[nodiscard]] Skeleton<SensorSpace> to_sensor(const Eigen::Isometry3d& sensor_from_world,
                                              const Skeleton<WorldSpace>& body);

}  // namespace chorus
