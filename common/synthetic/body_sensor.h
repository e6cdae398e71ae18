// The interface of every simulated body-tracking sensor: it yields frames in order, stamped by a
// host clock.
//
// Deterministic: the same scene, choice and start give the same frames.  sensor_choice.h makes a
// sensor from the name of its profile.
#pragma once

#include <optional>
#include <vector>

#include "common/sensor/sensor_frame.h"
#include "common/synthetic/host_clock.h"

namespace chorus::synthetic {

class BodySensor {
 public:
  virtual ~BodySensor() = default;

  /// The next frame in order of exposure; none when the frame was dropped.  `captured` is by the
  /// host's clock, `received` is true time.
  [[nodiscard]] virtual std::optional<SensorFrame> next() = 0;

  /// True time at which the frame that next() will return is exposed.
  [[nodiscard]] virtual Timestamp next_exposure() const = 0;

  [[nodiscard]] virtual const HostClock& clock() const noexcept = 0;

 protected:
  BodySensor() = default;
  BodySensor(const BodySensor&) = default;
  BodySensor& operator=(const BodySensor&) = default;
};

/// All frames from the next one up to `end` (true time).
[[nodiscard]] std::vector<SensorFrame> record(BodySensor& sensor, Timestamp end);

}  // namespace chorus::synthetic
