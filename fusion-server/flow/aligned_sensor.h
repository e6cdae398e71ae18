// What alignment hands on: each sensor's bodies at the common instant.
#pragma once

#include <vector>

#include "common/base/strong_id.h"
#include "common/body/body_frame.h"
#include "common/sensor/sensor_frame.h"

namespace chorus {

/// How a sensor's bodies at an instant were obtained.
enum class Basis {
  Exact,         ///< The sensor captured at exactly that instant.
  Interpolated,  ///< The instant is between two captures.
  Pending,       ///< A later capture may still arrive; ask again.
  /// There will be no bodies: no frames around the instant came in time, or the gap between them is
  /// too wide.
  Lost,
};

/// One sensor's bodies, moved to the common instant.
struct AlignedSensor {
  SensorId sensor;
  Basis basis = Basis::Lost;
  /// All of them have the common instant as their `captured`.  Empty unless the basis is Exact or
  /// Interpolated.
  std::vector<BodyFrame> bodies;
  std::optional<FloorPlane> floor;
};

}  // namespace chorus
