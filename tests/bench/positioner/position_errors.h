// How far found places are from the true ones.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace chorus::bench {

/// One instant: where somebody was found, and how sure the method was.
struct FoundPlace {
  std::optional<Eigen::Vector3d> place;  ///< None: not answered.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

struct PlaceScores {
  double rms = 0.0;     ///< [m]
  double median = 0.0;  ///< [m]
  double p95 = 0.0;     ///< [m]
  double answered = 0.0;
  double nees_along = 0.0;   ///< Mean square over the stated variance, along the line of sight.
  double nees_across = 0.0;  ///< The same across it, per axis.
  double rms_along = 0.0;    ///< [m]
  double rms_across = 0.0;   ///< Per axis [m].
};

/// `eye`: from where along and across count.
[[nodiscard]] PlaceScores scores_of(const std::vector<FoundPlace>& found,
                                    const std::vector<Eigen::Vector3d>& truth,
                                    const Eigen::Vector3d& eye);

}  // namespace chorus::bench
