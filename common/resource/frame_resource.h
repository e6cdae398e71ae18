// `/frame`: all bodies at one instant, of a sensor or of the fusion server, as one document.
//
// The same value on both sides, so that a fusion server can serve as a sensor for another one.
// Metres, Hamilton quaternions x y z w, UTC capture time.  proto/README.md is the specification.
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
  std::optional<std::size_t> slot;  ///< Fused: its number in every output, below kMaxBodies.
  /// Fused: probability that left and right are not exchanged, [0, 1].
  std::optional<double> sides_confidence;
  Timestamp captured;
  std::array<JointResource, kJointCount> joints;
};

struct FrameResource {
  std::uint64_t sequence = 0;
  Timestamp captured;
  std::string source;  ///< Sensor id, or "fusion".
  SpaceKind space = SpaceKind::Sensor;
  std::vector<std::string> sensors;  ///< Fused: names behind the contributor bits (at most 64).
  std::vector<BodyResource> bodies;  ///< Distinct ids, at most kMaxBodies.
};

/// How far from length 1 the direction of a ray may be.
inline constexpr double kRayTolerance = 0.01;

/// Writes the default (compact) profile.  Numbers that are not finite or absurd are never written:
/// such a joint is written as not tracked, without a position.  Turtle and JSON come from
/// templates, which tests prove isomorphic to the Serd writer.
[[nodiscard]] std::string write(const FrameResource& frame, Format format, const Place& place = {});

/// The full ARVIDA pattern (proto/README.md, profile "arvida"), Turtle or N-Triples.
[[nodiscard]] std::string write_arvida(const FrameResource& frame, const Place& place = {},
                                       Format format = Format::Turtle);

/// One body of the frame, `/skeletons/{id}`: the same joints, with the frame's source, space and
/// sequence.
[[nodiscard]] std::string write_skeleton(const FrameResource& frame, const BodyResource& body,
                                         Format format, const Place& place);

/// Reads Turtle or N-Triples (compact profile, in any equivalent spelling), or JSON and JSON-LD in
/// the shape written above.  Refuses, naming subject and property: duplicate ids, missing times,
/// more than kMaxBodies, absurd numbers, wrong types, unknown states and joints.  Bounded in size
/// and nesting.
[[nodiscard]] Result<FrameResource> read_frame(std::string_view bytes, Format format);

/// A sensor's frame as resource, and back.  `received` is not on the wire; reading sets it.
[[nodiscard]] FrameResource to_resource(const SensorFrame& frame);
[[nodiscard]] SensorFrame to_sensor_frame(const FrameResource& frame, SensorId sensor,
                                          Timestamp received);

}  // namespace chorus::resource
