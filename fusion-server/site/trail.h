// Where one cell saw one person during the last seconds.
#pragma once

#include <deque>
#include <optional>

#include <Eigen/Core>

#include "common/time/timestamp.h"

namespace chorus::site {

/// A place at an instant: by our clock, in the world of the cell that told it.
struct Sample {
  Timestamp at;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();       ///< [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< [m/s]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< As stated [m^2].
};

class Trail {
 public:
  /// Samples that are not later than the last one are left out.
  void add(const Sample& sample);
  /// Between two samples that are at most 0.2 s apart; none elsewhere.
  [[nodiscard]] std::optional<Sample> at(Timestamp instant) const;
  [[nodiscard]] const std::deque<Sample>& samples() const { return samples_; }

 private:
  std::deque<Sample> samples_;  ///< Of the last 2.5 s.
};

}  // namespace chorus::site
