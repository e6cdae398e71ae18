// How each sensor of a recorded cell agrees with the fused bodies: rate, silences, residuals,
// place, clock, sides.
//
// A residual is a sensor's joint, moved into the world, minus the fused joint at the capture time
// of the sensor's frame (interpolated between two fused frames).  The fused body contains the
// sensor, so residuals are too small where few sensors see a joint; they show who disagrees, not
// who is right.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <memory>

#include <Eigen/Geometry>

#include "common/base/strong_id.h"
#include "common/quality/view_errors.h"
#include "common/resource/frame_resource.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::quality {

struct SensorQuality {
  std::size_t frames = 0;
  double rate = 0.0;  ///< Frames per second, over the time in which it delivered.
  /// [s], also before its first and after its last frame while other sensors delivered.
  double longest_silence = 0.0;
  double lateness = 0.0;     ///< 95 % of its frames came within this after their capture [s].
  double sees = 0.0;         ///< Share of its frames with somebody.
  double rays = 0.0;         ///< Share of those in which it knows directions alone.
  double repeated = 0.0;     ///< Share of those whose bodies are exactly those of the frame before.
  std::size_t compared = 0;  ///< Joints.
  double residual = 0.0;     ///< Median distance [m]; NaN: nothing was compared.
  double residual_p90 = 0.0;
  /// Median distance of each joint [m]; NaN: it was never compared.
  std::array<double, kJointCount> joints = [] {
    std::array<double, kJointCount> none{};
    none.fill(std::numeric_limits<double>::quiet_NaN());
    return none;
  }();
  /// Median of the trunk's residuals [m], in world axes, in the first and in the last third of the
  /// recording; NaN: nothing was compared then.
  Eigen::Vector3d offset_first = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset_last = Eigen::Vector3d::Zero();
  /// The same of the whole recording in the sensor's axes (z: along its view).
  Eigen::Vector3d offset_in_sensor = Eigen::Vector3d::Zero();
  /// By how much its capture times are too late, from residuals along the motion [s], in the whole
  /// recording, and in its first and last third; NaN: nobody moved.
  double clock = 0.0;
  double clock_first = 0.0;
  double clock_last = 0.0;
  /// Share of its views from the front that fit the fused body better with left and right
  /// exchanged.
  double exchanged = 0.0;
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
  /// Of the fused joints, by the disagreement of their views.
  [[nodiscard]] std::array<ViewError, kJointCount> view_errors() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::quality
