// From the poses of a suit to the frames of a sensor.  Pure.
#pragma once

#include <optional>

#include "common/sensor/sensor_frame.h"
#include "common/suit/walk.h"
#include "services/sensor/device/suit/suit_settings.h"

namespace chorus::suit {

/// What the device needs of one pose.
struct SuitInstant {
  SuitPose pose;
  Eigen::Vector3d claimed = Eigen::Vector3d::Zero();  ///< Where the suit's program puts SpineBase.
  Timestamp captured;
};

/// Sensor space is where the person began to walk: +y up, y = 0 on the floor.
class SuitFrames {
 public:
  SuitFrames(SensorId sensor, const SuitSettings& settings);

  /// The frame of a pose; none when it comes sooner after the one before than max_rate_hz allows.
  /// (Its steps count all the same.)
  [[nodiscard]] std::optional<SensorFrame> next(SuitInstant instant);

 private:
  [[nodiscard]] SuitPose sized(const SuitPose& pose);
  [[nodiscard]] Walked where(const SuitPose& pose, const Eigen::Vector3d& claimed);

  SensorId sensor_;
  SuitSettings settings_;
  std::optional<double> factor_{};  ///< On the lengths of bones, once known.
  std::optional<Walk> walk_{};
  std::optional<Eigen::Vector3d> claimed_{};
  std::optional<Timestamp> last_{};
  Walked stated_{};
  std::uint64_t sequence_ = 0;
};

}  // namespace chorus::suit
