// Tests whether a sensor's residuals of the last seconds differ from what is usual for it.
//
// For each of several window lengths the mean of the last blocks is compared with how such means
// have scattered so far; nothing is assumed about how long errors last (docs/papers/watch.md (2)).
#pragma once

#include <array>
#include <deque>

#include "fusion-server/watch/standing_error.h"

namespace chorus::watch {

inline constexpr std::array<std::size_t, 4> kWindows{4, 5, 6, 9};  ///< [blocks]
inline constexpr std::size_t kLongestWindow = kWindows.back();

/// The window that differs most; windows with a lasting shift come first.
struct Shift {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< Mean residual beyond the usual [m]; axes of
                                                   ///< Residual.
  double sigmas = 0.0;                             ///< Mahalanobis distance of `mean`.
  bool lasting = false;                            ///< True if both halves of the window show it.
  Timestamp since;                                 ///< Beginning of the window.
  std::set<SensorId> others;                       ///< The sensors that it was compared with.
};

class ShiftTest {
 public:
  ShiftTest();

  /// Compares the last blocks.  Learns the usual scatter from means of less than `learn_below`
  /// sigmas.
  [[nodiscard]] Shift test(const std::deque<Block>& recent, const StandingError& usual,
                           double learn_below);

 private:
  struct Scatter {
    Eigen::Matrix3d squares;
    double weight = 0.0;
  };
  std::array<Scatter, kWindows.size()> scatter_;
};

}  // namespace chorus::watch
