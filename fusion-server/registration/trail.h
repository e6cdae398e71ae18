// One sensor's walk, reduced to the points used for registration.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/body/skeleton.h"
#include "fusion-server/registration/registration.h"

namespace chorus::registration {

/// A joint, or the midpoint of two.  The midpoint of a mirror pair does not depend on which side
/// the sensor calls left, so it is not affected by swapped sides.
struct Slot {
  JointId first;
  JointId second;
  double sigma;  ///< Measurement error of a sensor, relative to other slots [m].
};

[[nodiscard]] std::span<const Slot> slots_of(JointChoice choice);

/// The slots of the single body in a frame.
struct TrailFrame {
  Timestamp captured;
  BodyId body;
  std::array<Eigen::Vector3d, kJointCount> points;  ///< By slot; defined where `seen` has the bit.
  std::uint32_t seen = 0;
  /// True if the body is at least 12 mm away from where it was in the last frame with `moved`, or
  /// if it is not the same body.  While a person rests, a joint's error stays the same, too, so all
  /// frames of a rest amount to one measurement.
  bool moved = true;

  [[nodiscard]] bool has(std::size_t slot) const { return (seen >> slot & 1U) != 0; }
};

struct Trail {
  SensorId sensor;
  std::vector<TrailFrame> frames;  ///< Strictly increasing in time.
  bool stood = false;              ///< Somebody was left out because they never moved.
};

/// Uses frames with exactly one body, and only tracked joints.  Bodies that are seen for a second
/// or more, with the neck always within 30 mm, do not count: sensors take furniture for people.
/// Frames with several other bodies would first need association across sensors; the place for that
/// is sole_body() in trail.cpp.
[[nodiscard]] Trail trail_of(const WalkTrack& walk, JointChoice choice);

/// Why a trail has no frames.
[[nodiscard]] std::string why_empty(const Trail& trail);

/// The middle of the walk as this sensor saw it: mean of the first slot [m].
[[nodiscard]] Eigen::Vector3d middle_of(const Trail& trail);

}  // namespace chorus::registration
