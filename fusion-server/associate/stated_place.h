// Distances between bodies whose sensors state how uncertain their places are.
//
// A camera that guesses how far away people are from their size is wrong by decimetres along its
// line of sight.  Its bodies may then be farther from where others see the person than a depth
// sensor's, but only in that direction.
#pragma once

#include <Eigen/Core>

#include "common/body/skeleton.h"

namespace chorus::associate {

/// x and z of a place.
[[nodiscard]] inline Eigen::Vector2d on_floor(const Eigen::Vector3d& place) {
  return {place.x(), place.z()};
}

/// Covariance on the floor, of x and z [m^2].
using PlanError = Eigen::Matrix2d;

/// Horizontal distance [m].  Height is ignored: people do not stand on each other, and an occluded
/// hip must not move a body away from its track.
[[nodiscard]] double horizontal_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// The same for a difference that has the covariance `error`, to be compared with `limit` [m]: in a
/// direction with standard deviation s, a difference of sqrt(limit^2 + (3 s)^2) has the distance
/// `limit`.
[[nodiscard]] double horizontal_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                         const PlanError& error, double limit);

/// What the sensor states about the place of the whole body: the mean over the core joints, because
/// all of them are wrong together; zero if it states nothing.
[[nodiscard]] PlanError stated_error(const Skeleton<WorldSpace>& body);

/// Weighted mean of places.
class MeanPlace {
 public:
  void add(const Eigen::Vector3d& place, const PlanError& error);
  [[nodiscard]] bool empty() const { return count_ == 0.0; }
  /// Call this only after a place was added.
  [[nodiscard]] Eigen::Vector3d place() const;
  /// Zero if no place had an error.
  [[nodiscard]] PlanError error() const;

 private:
  Eigen::Matrix2d weight_ = Eigen::Matrix2d::Zero();
  Eigen::Vector2d weighted_ = Eigen::Vector2d::Zero();
  double height_ = 0.0;
  double count_ = 0.0;
};

}  // namespace chorus::associate
