// The statistics by which a log of one body is known: computed alike from real and from simulated
// frames.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "common/body/bones.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::bench {

struct LogStatistics {
  std::array<Eigen::Vector3d, kJointCount> white{};  ///< Robust white noise per axis, tracked [m]
  std::array<Eigen::Vector3d, kJointCount> white_inferred{};  ///< The same while inferred [m]
  std::array<double, kJointCount> inferred_share{};           ///< Of the frames that saw the joint.
  std::map<JointId, double> bone_std;                         ///< By child joint [m]
  std::map<JointId, double> lag_frame;  ///< Autocorrelation of the bone length, next frame.
  std::map<JointId, double> lag_third;  ///< After a third of a second.
  std::map<JointId, double> lag_later;  ///< After 0.4 s.
  std::array<double, 3> steps{};        ///< Between frames: median, 95 %, longest [s]
  std::size_t unoriented = 0;           ///< Joints whose orientation never came.
  std::size_t frames = 0;
};

/// Of the body with this id, or of the first one of each frame.  Frames must be in capture order;
/// third differences are taken only over four frames at the usual pace.
[[nodiscard]] LogStatistics statistics_of(const std::vector<SensorFrame>& frames);

/// Standard deviation, and autocorrelation at a lag given in samples; NaN for too few.
[[nodiscard]] double deviation(const std::vector<double>& values);
[[nodiscard]] double autocorrelation(const std::vector<double>& values, std::size_t lag);

}  // namespace chorus::bench
