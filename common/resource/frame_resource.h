// `/frame`: all bodies at one instant, of a sensor or of the fusion server, as one document.
//
// Sensors and the fusion server use the same type, so a fusion server can be a sensor of another
// one. Metres, Hamilton quaternions x y z w, UTC capture time; specified in proto/README.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/body/hand_points.h"
#include "common/body/skeleton.h"
#include "common/resource/media_type.h"
#include "common/resource/place.h"
#include "common/sensor/limits.h"
#include "common/sensor/sensor_frame.h"
#include "common/sensor/shares.h"

namespace chorus::resource {

enum class SpaceKind { Sensor, World };

struct JointResource : Joint {
  std::optional<double> variance;  ///< Fused: mean variance per axis [m^2].
  std::uint64_t contributors = 0;  ///< Fused: bit i = FrameResource::sensors[i] contributed.
  Shares shares =
      {};  ///< Fused: of FrameResource::sensors[i], at that index; of contributors only.
  /// Fused: time since a sensor last contributed to the joint [s]; none while one does.
  std::optional<double> age = {};
  std::optional<Eigen::Vector3d> velocity = {};  ///< Fused [m/s].
  std::optional<double> velocity_variance = {};  ///< Fused: per axis, alike on all [m^2/s^2].
  /// Fused: length of the bone that ends in the joint, and its standard deviation [m].
  std::optional<double> bone_length = {};
  std::optional<double> bone_sigma = {};
  /// Of `orientation`, about the axes of the space [rad^2], if it is known.
  Covariance orientation_covariance = {};
};

struct BodyResource {
  std::uint64_t id = 0;
  std::optional<std::size_t> slot;  ///< Fused: the person's slot in every output, below kMaxBodies.
  /// Fused: probability that left and right are not swapped, [0, 1].
  std::optional<double> sides_confidence;
  /// Fused: for how long no sensor has seen the person [s]; meanwhile the joints are where they are
  /// expected.  None while the person is seen.
  std::optional<double> carried_for;
  /// Fused: for how long after the instant what sensors saw was taken into account [s].  None: the
  /// body is what was known at the instant.
  std::optional<double> smoothed_over;
  std::optional<Eigen::Vector3d> velocity;  ///< Fused: of the middle of the trunk [m/s].
  std::optional<double> velocity_variance;  ///< Fused: per axis, alike on all [m^2/s^2].
  std::optional<double> stature;            ///< Fused [m].
  std::optional<double> stature_sigma;      ///< Fused: its standard deviation [m].
  std::optional<std::string> method;        ///< Fused: name of the fusion method.
  std::optional<HandPoints> left_hand;      ///< In the frame's space.
  std::optional<HandPoints> right_hand;
  Timestamp captured;
  std::array<JointResource, kJointCount> joints;
};

/// Fused: a thing that somebody holds, as a rigid body.
struct PropResource {
  std::string name;  ///< 1-32 characters of [A-Za-z0-9_-]; unique in a frame.
  std::optional<std::uint64_t> holder = {};            ///< Id of the body that holds it.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  std::optional<double> place_sigma = {};         ///< Per axis [m].
  std::optional<double> turn_sigma_degrees = {};  ///< As on the wire.
};

/// Most things in hands that a frame tells of.
inline constexpr std::size_t kMaxProps = 64;

struct FrameResource {
  std::uint64_t sequence = 0;
  Timestamp captured;
  std::string source;  ///< Sensor id, or "fusion".
  SpaceKind space = SpaceKind::Sensor;
  /// Fused: version of the registration that placed the sensors.
  std::optional<std::uint64_t> registration_version = {};
  std::vector<std::string> sensors;  ///< Fused: the sensors of the contributor bits (at most 64).
  std::vector<BodyResource> bodies;  ///< At most kMaxBodies, with distinct ids.
  std::vector<PropResource> props = {};  ///< At most kMaxProps, with distinct names.
};

/// How far the length of a ray's direction may be from 1.
inline constexpr double kRayTolerance = 0.01;
/// Longest span of time that is written or accepted [s].
inline constexpr double kLongestCarry = 3600.0;

/// Writes the default (compact) profile.  A joint whose position is not finite or not plausible is
/// written as not tracked, without a position.  Such a variance or covariance is left out, and so
/// is an orientation that is zero or not finite; one of a wrong length is normalised.  Turtle and
/// JSON come from templates; tests prove that their output is isomorphic to the Serd writer's.
[[nodiscard]] std::string write(const FrameResource& frame, Format format, const Place& place = {});

/// Writes the full ARVIDA pattern (proto/README.md, profile "arvida") in Turtle or N-Triples.
[[nodiscard]] std::string write_arvida(const FrameResource& frame, const Place& place = {},
                                       Format format = Format::Turtle);

/// Writes the lean form in JSON (?form=pose): of each body id, slot, certainty of sides and how
/// long it has been out of sight; of each joint its place, to the millimetre, and its state.
[[nodiscard]] std::string write_pose(const FrameResource& frame);

/// Writes one body of the frame, `/skeletons/{id}`: its joints, with the frame's source, space and
/// sequence.
[[nodiscard]] std::string write_skeleton(const FrameResource& frame, const BodyResource& body,
                                         Format format, const Place& place);

/// Reads Turtle or N-Triples (compact profile, in any equivalent spelling), or JSON and JSON-LD in
/// the form that write() produces.  Refuses duplicate ids, missing times, more than kMaxBodies,
/// implausible numbers, wrong types, unknown states and joints; errors name subject and property.
/// Limits size and nesting.
[[nodiscard]] Result<FrameResource> read_frame(std::string_view bytes, Format format);

/// Convert between a sensor's frame and its resource.  `received` is not on the wire, so the reader
/// supplies it; neither are `floor` and `clock_sigma`, so a frame that was read has none.
[[nodiscard]] FrameResource to_resource(const SensorFrame& frame);
[[nodiscard]] SensorFrame to_sensor_frame(const FrameResource& frame, SensorId sensor,
                                          Timestamp received);

}  // namespace chorus::resource
