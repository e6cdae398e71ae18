// All bodies that one sensor saw at one instant.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/strong_id.h"
#include "common/body/body_frame.h"
#include "common/geometry/plane.h"
#include "common/sensor/limits.h"
#include "common/time/timestamp.h"

namespace chorus {

/// The floor in sensor space: unit normal n (up) and offset d [m] with n.x + d = 0; d is the
/// sensor's height above the floor.
using FloorPlane = Plane;

struct SensorFrame {
  SensorId sensor;
  std::uint64_t sequence = 0;  ///< Counts the sensor's frames; a gap means lost frames.
  Timestamp captured;          ///< When light hit the sensor, by the sensor host's clock.
  Timestamp received;          ///< When this process got the frame, by its own clock.
  std::vector<BodyFrame> bodies;
  std::optional<FloorPlane> floor;
  /// How far the capture time may be wrong relative to other sensors' clocks, as a standard
  /// deviation [s].
  double clock_sigma = 0.0;
};

/// Moves a frame and its bodies in time.
inline void move_in_time(SensorFrame& frame, Duration by) {
  frame.captured += by;
  for (BodyFrame& body : frame.bodies) body.captured += by;
}

}  // namespace chorus
