// One sensor's walk, reduced to the points that registration uses.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fusion-server/registration/registration.h"

namespace chorus::registration {

/// A joint, or the midpoint of two.  The midpoint of a mirror pair is the same whichever side the
/// sensor calls left, so it survives front/rear flips.
struct Slot {
  JointId first;
  JointId second;
  double sigma;  ///< Error of one sensor's measurement, to weigh the slots against one another [m].
};

[[nodiscard]] std::span<const Slot> slots_of(JointChoice choice);

/// The slots of the only body in a frame.
struct TrailFrame {
  Timestamp captured;
  BodyId body;
  std::array<Eigen::Vector3d, kJointCount> points;  ///< By slot; defined where `seen` has the bit.
  std::uint32_t seen = 0;

  [[nodiscard]] bool has(std::size_t slot) const { return (seen >> slot & 1U) != 0; }
};

struct Trail {
  SensorId sensor;
  std::vector<TrailFrame> frames;  ///< Strictly increasing in time.
};

/// Frames with exactly one body, tracked joints only.  Frames with several bodies need association
/// across sensors first; `sole_body` is where that would go.
[[nodiscard]] Trail trail_of(const WalkTrack& walk, JointChoice choice);

}  // namespace chorus::registration
