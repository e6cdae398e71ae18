// Tests whether a sensor's residuals of the last seconds differ from what is usual for it.
//
// The median of the last blocks is compared with how such medians have scattered so far; nothing is
// assumed about how long errors last (docs/papers/watch.md (2)).
#pragma once

#include <deque>

#include "fusion-server/watch/standing_error.h"

namespace chorus::watch {

/// A sensor that was moved shows it in most of these blocks after half the window; a passing error
/// of tracking has to last as long.
inline constexpr std::size_t kWindow = 7;  ///< [blocks]

struct Shift {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< Beyond the usual [m]; axes of Residual.
  double sigmas = 0.0;                               ///< Mahalanobis distance of `middle`.
  Timestamp since;                                   ///< Beginning of the window.
  std::set<SensorId> others;                         ///< The sensors that it was compared with.
};

class ShiftTest {
 public:
  ShiftTest();

  /// Compares the last kWindow blocks; no shift if there are fewer.  Learns the usual scatter from
  /// medians of less than `learn_below` sigmas.
  [[nodiscard]] Shift test(const std::deque<Block>& recent, const StandingError& usual,
                           double learn_below);

 private:
  Eigen::Matrix3d squares_;  ///< Weighted sum of the medians' squares [m^2].
  double weight_;
};

}  // namespace chorus::watch
