// Statistics of a log of one body, computed in the same way from real and from simulated
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
  std::array<Eigen::Vector3d, kJointCount> white_inferred{};  ///< White noise while inferred [m]
  /// Fraction of the joint's frames in which it is inferred.
  std::array<double, kJointCount> inferred_share{};
  /// Standard deviation of a bone's length, by child joint [m]
  std::map<JointId, double> bone_std;
  std::map<JointId, double> lag_frame;  ///< Autocorrelation of a bone's length after one frame.
  std::map<JointId, double> lag_third;  ///< Autocorrelation after a third of a second.
  std::map<JointId, double> lag_later;  ///< Autocorrelation after 0.4 s.
  std::array<double, 3> steps{};        ///< Time between frames: median, 95 %, longest [s]
  std::size_t unoriented = 0;           ///< Joints that never had an orientation.
  std::size_t frames = 0;
};

/// Statistics of the first body of each frame.  Frames must be in capture order; third differences
/// are taken only over four frames at the usual rate.
[[nodiscard]] LogStatistics statistics_of(const std::vector<SensorFrame>& frames);

/// Standard deviation, and autocorrelation at a lag given in samples; NaN if there are too few
/// values.
[[nodiscard]] double deviation(const std::vector<double>& values);
[[nodiscard]] double autocorrelation(const std::vector<double>& values, std::size_t lag);

}  // namespace chorus::bench
