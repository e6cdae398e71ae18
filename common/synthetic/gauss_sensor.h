// The plain profile as a sensor: white noise and an exact clock (see sensor_model.h).
#pragma once

#include "common/synthetic/body_sensor.h"
#include "common/synthetic/scene.h"
#include "common/synthetic/sensor_model.h"

namespace chorus::synthetic {

class GaussSensor final : public BodySensor {
 public:
  /// `scene` must outlive the sensor.  The first frames are at or after `start`.
  GaussSensor(const Scene& scene, SimulatedSensor sensor, Timestamp start)
      : scene_(&scene), sensor_(std::move(sensor)), number_(first_frame_from(sensor_, start)) {}

  [[nodiscard]] std::optional<SensorFrame> next() override {
    return observe(*scene_, sensor_, number_++);
  }
  [[nodiscard]] Timestamp next_exposure() const override { return capture_time(sensor_, number_); }
  [[nodiscard]] const HostClock& clock() const noexcept override { return clock_; }

 private:
  const Scene* scene_;
  SimulatedSensor sensor_;
  HostClock clock_;
  std::uint64_t number_;
};

}  // namespace chorus::synthetic
