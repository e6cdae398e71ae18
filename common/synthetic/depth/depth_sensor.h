// Profile C: a sensor that renders depth images of the truth, measures them as a time-of-flight
// camera would and fits a generic body to them.  The errors of joints result from the fit; none is
// drawn.
//
// The times of exposure and arrival, lost frames, the floor plane and the host's clock are
// simulated as in kinect/.
#pragma once

#include <vector>

#include "common/synthetic/body_sensor.h"
#include "common/synthetic/depth/body_tracker.h"
#include "common/synthetic/kinect/delivery.h"
#include "common/synthetic/scene.h"

namespace chorus::synthetic::depth {

struct DepthSetting {
  SensorId id;
  std::size_t place = 0;  ///< Index into Scene::world_from_sensor.
  DepthProfile profile;
  std::uint64_t seed = 1;
  std::uint64_t people_seed = 1;  ///< Seed of people's build and clothing; equal for all sensors.
  /// True: frames are stamped by the host's clock with its errors.  False: by true time.
  bool own_clock = true;
};

class DepthSensor final : public BodySensor {
 public:
  /// `scene` must outlive the sensor.  The first frames are at or after `start`.
  DepthSensor(const Scene& scene, DepthSetting setting, Timestamp start);

  [[nodiscard]] std::optional<SensorFrame> next() override;
  [[nodiscard]] Timestamp next_exposure() const override;
  [[nodiscard]] const HostClock& clock() const noexcept override { return clock_; }

 private:
  [[nodiscard]] View view(Timestamp exposed) const;
  [[nodiscard]] kinect::ErrorKeys keys() const { return {setting_.seed, setting_.place, 0}; }

  const Scene* scene_;
  DepthSetting setting_;
  HostClock clock_;
  std::uint64_t number_;
  std::vector<Build> builds_;
  DepthCamera camera_;
  kinect::FloorError floor_ = kinect::nominal_profile("A").floor;  ///< As in profile A.
  BodyTracker tracker_;
};

}  // namespace chorus::synthetic::depth
