// How each sensor of a recorded cell agrees with the fused bodies: rate, silences, residuals,
// clock.
//
// A residual is a sensor's joint, moved into the world, minus the fused joint at the capture time
// of the sensor's frame (interpolated between two fused frames).  The fused body contains the
// sensor, so residuals are too small where few sensors see a joint; they show who disagrees, not
// who is right.
#pragma once

#include <map>
#include <memory>
#include <string>

#include <Eigen/Geometry>

#include "common/base/strong_id.h"
#include "common/resource/frame_resource.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::quality {

struct SensorQuality {
  std::size_t frames = 0;
  double rate = 0.0;             ///< Frames per second, over the time in which it delivered.
  double longest_silence = 0.0;  ///< [s]
  double lateness = 0.0;         ///< 95 % of its frames came within this after their capture [s].
  double sees = 0.0;             ///< Share of its frames with somebody.
  std::size_t compared = 0;      ///< Joints.
  double residual = 0.0;         ///< Median distance [m]; NaN: nothing was compared.
  double residual_p90 = 0.0;
  /// Median of the centre joints' residuals [m], in the first and in the last third of the
  /// recording.
  Eigen::Vector3d offset_first = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset_last = Eigen::Vector3d::Zero();
  /// By how much its capture times are too late, from residuals along the motion [s]; NaN: nobody
  /// moved.
  double clock = 0.0;
  /// Residual by distance from the sensor: below 2 m, 2-3, 3-4, farther [m]; NaN: none there.
  std::array<double, 4> by_distance{};
};

/// Takes frames in any order that a recording has: a fused frame may come up to two seconds after
/// the sensors' frames of its instant.
class SensorJudge {
 public:
  SensorJudge();
  ~SensorJudge();
  SensorJudge(SensorJudge&&) noexcept;

  /// Where the sensors stand from now on.
  void place(std::map<SensorId, Eigen::Isometry3d> world_from_sensor);
  void add(const SensorFrame& frame);
  void add(const resource::FrameResource& fused);
  [[nodiscard]] std::map<SensorId, SensorQuality> finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::quality
