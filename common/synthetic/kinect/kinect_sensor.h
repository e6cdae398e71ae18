// One simulated body-tracking depth sensor.  It applies the layers of error in this order, frame by
// frame:
//
//   truth -> visibility -> states -> bias -> yaw behaviour and flip -> view limits -> gaps
//         -> merged legs -> coloured and white error, teleports -> fitted body -> ghosts and ids
//         -> drops, latency, clock
//
// Deterministic: the same scene, setting and start give the same frames.
#pragma once

#include <optional>
#include <vector>

#include "common/synthetic/body_sensor.h"
#include "common/synthetic/kinect/delivery.h"
#include "common/synthetic/kinect/fitted_body.h"
#include "common/synthetic/kinect/gross_error.h"
#include "common/synthetic/kinect/joint_bias.h"
#include "common/synthetic/kinect/profile.h"
#include "common/synthetic/kinect/visibility.h"
#include "common/synthetic/kinect/yaw_behaviour.h"
#include "common/synthetic/scene.h"

namespace chorus::synthetic::kinect {

struct KinectSetting {
  SensorId id;
  std::size_t place = 0;  ///< Index into Scene::world_from_sensor.
  Profile profile;
  /// Seed of all errors but the biases; the same for all sensors of a room, because they share some
  /// errors.
  std::uint64_t seed = 1;
  /// Seed of the biases of the SDK and of people; meant to be the same in every run.
  std::uint64_t bias_seed = 1;
  /// True: frames are stamped by the host's clock with its errors.  False: by true time.
  bool own_clock = true;
  /// True: each joint's covariance is the true mean square of its error (error_moment.h).  No real
  /// sensor knows that; it serves to compute bounds.
  bool confides = false;
};

class KinectSensor final : public BodySensor {
 public:
  /// `scene` must outlive the sensor.  The first frames are at or after `start`.
  KinectSensor(const Scene& scene, KinectSetting setting, Timestamp start);

  [[nodiscard]] std::optional<SensorFrame> next() override;
  [[nodiscard]] Timestamp next_exposure() const override;
  [[nodiscard]] const HostClock& clock() const noexcept override { return clock_; }

 private:
  struct Memory {
    FlipState flip;
    /// How far each joint is hidden, as noticed by the SDK: 0 (seen) to 1.
    std::array<double, kJointCount> hidden{};
    ColouredState coloured;
    FitState fit;
    PersonHarmonics bias{};
    Proportions proportions{};
    std::optional<Skeleton<SensorSpace>> before;  ///< The exact body one frame ago.
  };
  void look(Timestamp exposed);
  [[nodiscard]] std::optional<Skeleton<SensorSpace>> shown(std::size_t person, Timestamp exposed);
  void err(Skeleton<SensorSpace>& body, std::size_t person, const Stand& stand, double time) const;
  [[nodiscard]] Stand stand_of(std::size_t person) const;
  [[nodiscard]] ErrorKeys keys(std::size_t person) const;

  const Scene* scene_;
  KinectSetting setting_;
  HostClock clock_;
  std::uint64_t number_;
  std::vector<Memory> memory_;
  IdBook ids_;
  std::vector<Skeleton<SensorSpace>> bodies_;  ///< All exact bodies at the current exposure.
  Obstacles obstacles_;
};

/// All frames of one sensor from start to end.
[[nodiscard]] std::vector<SensorFrame> record(const Scene& scene, const KinectSetting& setting,
                                              Timestamp start, Timestamp end);

}  // namespace chorus::synthetic::kinect
