// `/frame`: all bodies at one instant, of a sensor or of the fusion server, as one document.
//
// Sensors and the fusion server use the same value, so a fusion server can be another one's sensor.
// Metres, Hamilton quaternions x y z w, UTC capture time; specified in proto/README.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/body/skeleton.h"
#include "common/resource/media_type.h"
#include "common/resource/place.h"
#include "common/sensor/limits.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::resource {

enum class SpaceKind { Sensor, World };

struct JointResource : Joint {
  std::optional<double> variance;  ///< Fused: mean variance per axis [m^2].
  std::uint64_t contributors = 0;  ///< Fused: bit i = FrameResource::sensors[i] contributed.
};

struct BodyResource {
  std::uint64_t id = 0;
  std::optional<std::size_t> slot;  ///< Fused: its slot in every output, below kMaxBodies.
  /// Fused: probability that left and right are not exchanged, [0, 1].
  std::optional<double> sides_confidence;
  /// Fused: for how long no sensor has seen the person, who is where they are expected [s]; none:
  /// seen.
  std::optional<double> carried_for;
  Timestamp captured;
  std::array<JointResource, kJointCount> joints;
};

struct FrameResource {
  std::uint64_t sequence = 0;
  Timestamp captured;
  std::string source;  ///< Sensor id, or "fusion".
  SpaceKind space = SpaceKind::Sensor;
  std::vector<std::string> sensors;  ///< Fused: names for the contributor bits (at most 64).
  std::vector<BodyResource> bodies;  ///< With distinct ids, at most kMaxBodies.
};

/// How far the length of a ray's direction may be from 1.
inline constexpr double kRayTolerance = 0.01;

/// Writes the default (compact) profile.  Never writes numbers that are not finite or are absurd:
/// such a joint is written as not tracked, without a position.  Turtle and JSON come from
/// templates; tests prove these isomorphic to the Serd writer.
[[nodiscard]] std::string write(const FrameResource& frame, Format format, const Place& place = {});

/// The full ARVIDA pattern (proto/README.md, profile "arvida"), Turtle or N-Triples.
[[nodiscard]] std::string write_arvida(const FrameResource& frame, const Place& place = {},
                                       Format format = Format::Turtle);

/// One body of the frame, `/skeletons/{id}`: the same joints, with the frame's source, space and
/// sequence.
[[nodiscard]] std::string write_skeleton(const FrameResource& frame, const BodyResource& body,
                                         Format format, const Place& place);

/// Reads Turtle or N-Triples (compact profile, in any equivalent spelling), or JSON and JSON-LD in
/// the shape written above.  Refuses duplicate ids, missing times, more than kMaxBodies, absurd
/// numbers, wrong types, unknown states and joints; errors name subject and property.  Limited in
/// size and nesting.
[[nodiscard]] Result<FrameResource> read_frame(std::string_view bytes, Format format);

/// A sensor's frame as a resource, and back.  `received` is not on the wire; reading sets it.
[[nodiscard]] FrameResource to_resource(const SensorFrame& frame);
[[nodiscard]] SensorFrame to_sensor_frame(const FrameResource& frame, SensorId sensor,
                                          Timestamp received);

}  // namespace chorus::resource
