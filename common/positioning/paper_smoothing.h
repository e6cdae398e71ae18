// What Madaras et al. do with the places afterwards (3.7): a Gaussian over 20 instants, or a Kalman
// filter.  Both need the whole take or lag behind, so they are for files and comparisons.
#pragma once

#include <span>
#include <vector>

#include "common/positioning/take.h"

namespace chorus::positioning {

/// Each place becomes the mean of those around, weighted by a Gaussian that spans `steps` instants
/// (3 standard deviations to each side); fewer at the ends.
[[nodiscard]] std::vector<Eigen::Vector3d> gauss_smoothed(std::span<const Eigen::Vector3d> places,
                                                          int steps = 20);

struct KalmanSettings {
  double period = 1.0 / 30.0;  ///< Between two places [s].
  double acceleration = 4.0;   ///< Of a walking person, white [m/s^2].
  double place = 0.1;          ///< Error of one place: the paper's step d [m].
};

/// A constant-velocity Kalman filter, forwards only, as the paper uses OpenCV's.  (The paper calls
/// it extended; with places as measurements nothing in it is nonlinear.)
[[nodiscard]] std::vector<Eigen::Vector3d> kalman_smoothed(std::span<const Eigen::Vector3d> places,
                                                           const KalmanSettings& settings = {});

/// Sets `smooth` of all to the Gaussian of `online`; the covariance stays.
void gauss_smooth(std::vector<Placed>& placed);

}  // namespace chorus::positioning
